# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What pyproject.toml cannot say: the scenes and their shapes go into the wheel, below the package."""

from setuptools import find_packages, setup

PARTS = ["examples", *(f"examples.{part}" for part in find_packages("examples")), "assets"]
SHAPES = ["*.usda", "*.usdc", "*.obj", "melon_*.png"]

setup(
    packages=[*find_packages(include=["newton_cagecut*"]), *(f"newton_cagecut.{part}" for part in PARTS)],
    package_dir={f"newton_cagecut.{folder}": folder for folder in ("examples", "assets")},
    package_data={"newton_cagecut": ["py.typed"], "newton_cagecut.assets": SHAPES},  # py.typed: the annotations count
)
