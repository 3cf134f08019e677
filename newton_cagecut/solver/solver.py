# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""``SolverCageCut``: elastic bodies in cages, cut while they move, as a Newton solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING

import newton
import numpy as np
import warp as wp

from ..geometry import as_flag, as_instance, as_number, shown
from ..section import Blade
from .body.body_labels import body_labels
from .body.body_pieces import BodyPiece
from .body.cage_body import CageBody
from .body.edit_stamps import EditStamps, state_edits
from .body.simulated_body import SimulatedBody
from .body.step_watch import StepWatch
from .builder import register_custom_attributes
from .config import Config
from .contact.rigid_reactions import RigidReactions
from .cut.body_cut import BodyCut
from .cut.body_snapshot import BodySnapshot
from .cut.cut_report import CutReport
from .live.foreign_rows import ForeignRows
from .live.live_solver import LiveSolver, refuse_gradients, refuse_state_gradients
from .live.vertex_motion import targets_of
from .plan import PlanEntry, plan_of, plan_of_scene
from .progress_bars import fraction_bar
from .step_arguments import StepArguments
from .viewing import SurfaceViewer
from .warm_up import warm_up

if TYPE_CHECKING:  # a scene without animations does not import USD
    from ..usd import SceneFrame
    from .scene_recorder import SceneRecorder


class SolverCageCut(LiveSolver):
    """Simulates the cage bodies of a model and cuts them.

    Each body is a reduced elastic model whose shape functions are the harmonic coordinates of its cage, advanced by
    TR-BDF2 or, if asked for, by the paper's single Newton step of backward Euler (section 6.1); see :class:`Config`.
    ``step`` only launches kernels, so it can be captured in a CUDA graph, which stays valid across cuts.

    Args:
        model: The model, with bodies added by ``add_cage_body``.
        config: How to solve; the defaults of :class:`Config` if not given.
        progress: Whether to show a bar while the weights are computed, by default in a terminal; or a function that is
            called with the finished fraction between 0 and 1.
        options: Fields of :class:`Config`, which override those of ``config``.

    Raises:
        TypeError: There is no such option, or an option or ``config`` has the wrong type.
        ValueError: The model has no cage bodies, or an option is out of its range.
    """

    Config = Config

    def __init__(
        self,
        model: newton.Model,
        config: Config | None = None,
        *,
        progress: bool | Callable[[float], None] | None = None,
        **options: object,
    ) -> None:
        self._config = Config.of(config, options)
        as_instance(model, newton.Model, "model", hint="builder.finalize() makes one")
        if not callable(progress) and progress is not None:
            as_flag(progress, "progress, unless it is a function or None,")
        super().__init__(model)
        refuse_gradients(model)
        rows = getattr(model, "cagecut", None)
        definitions = list(rows.definition) if rows is not None else []
        if not definitions:
            raise ValueError(
                "the model has no cage bodies: call SolverCageCut.register_custom_attributes(builder) and "
                "add_cage_body(builder, ...) before builder.finalize()"
            )
        count = len(definitions)
        self._stamps = EditStamps(model, body_labels(model))
        with fraction_bar("weights", shown=progress) if not callable(progress) else nullcontext(progress) as report:
            self._simulated = [
                SimulatedBody(
                    model,
                    row,
                    self._stamps,
                    config=self._config,
                    progress=lambda fraction, done=row: report((done + fraction) / count),
                )
                for row in range(count)
            ]
        self._bodies = tuple(CageBody(body) for body in self._simulated)
        parts = [part for body in self._bodies for part in (body.vertices, body.surface_particles) if part is not None]
        self._foreign = ForeignRows(model, parts, self._config.foreign)
        self._viewer = SurfaceViewer()
        self._recorder: SceneRecorder | None = None
        labels, systems = zip(*((body.label, body.system) for body in self._simulated), strict=True)
        self._reactions = RigidReactions(model, self._simulated)
        self._arguments = StepArguments(model, self._stamps)
        self._watch = StepWatch(labels, systems, model.device)

    @classmethod
    def register_custom_attributes(cls, builder: newton.ModelBuilder) -> None:
        """Declare what ``add_cage_body`` needs of a builder; calling it again changes nothing."""
        register_custom_attributes(builder)

    @property
    def config(self) -> Config:
        """How the solver solves."""
        return self._config

    @property
    def bodies(self) -> tuple[CageBody, ...]:
        """The cage bodies, in the order in which they were added."""
        return self._bodies

    def body(self, body: int | str) -> CageBody:
        """A body by index or label.

        Raises:
            ValueError: There is no such body.
        """
        return self._bodies[self._row(body)]

    def _row(self, body: int | str) -> int:
        labels = [candidate.label for candidate in self._simulated]
        if isinstance(body, str) and body in labels:
            return labels.index(body)
        if isinstance(body, int | np.integer) and not isinstance(body, bool) and 0 <= body < len(labels):
            return int(body)
        raise ValueError(f"there is no cage body {shown(body)}; there are {len(labels)}: {', '.join(labels)}")

    def _own(self, item: BodyCut | BodySnapshot, what: str) -> None:
        """Refuse cuts and snapshots of another solver's bodies."""
        if item.body not in self._simulated:
            raise ValueError(f"the {what} is of a body of another solver; use the one that made it")

    def step(
        self,
        state_in: newton.State,
        state_out: newton.State,
        control: newton.Control | None,
        contacts: newton.Contacts | None,
        dt: float,
        *,
        observables: newton.solvers.SolverBase.Observables | None = None,
    ) -> None:
        """Advance all cage bodies by one step; what is not theirs is copied through, see ``Config.foreign``.

        Contacts push both ways: what they do to rigid bodies is added to ``state_in.body_f``, about the centres of
        mass, for the solver that steps those from ``state_in`` afterwards. ``state_in.particle_f`` acts on cage
        vertices and, of bodies with a contact radius, on surface points.

        A body whose rows of ``state_in`` missed an edit is left where it is there, and counted: in a replay of a
        captured graph nothing else can be done. Outside of a capture that raises, then or at the next call.

        Args:
            state_in: State before the step.
            state_out: State after it; may be the same.
            control: Where fixed vertices are to go: rows of ``control.cagecut.target_q``, one a particle [m]; infinity,
                which all are at first, keeps a vertex where it is. The model's own without a control.
            contacts: Contacts of Newton's collision pipeline, for bodies with a contact radius.
            dt: Time step [s].
            observables: Not supported beyond Newton's checks.

        Raises:
            TypeError: An argument has the wrong type.
            ValueError: The time step is not positive and finite, states or contacts are of another model, the contacts
                were reduced by body pairs, or ``state_in`` missed an edit of a body.
        """
        seconds = self._arguments.check(state_in, state_out, control, contacts, dt)
        if observables is not None:
            as_instance(observables, self.Observables, "observables", hint="or None")
            self.validate_observables(observables, contacts)
        self._require_unreduced_contacts(contacts)
        targets = targets_of(self.model, control)
        refuse_state_gradients(state_in)
        self._stamps.compare(state_in)
        if not self.model.device.is_capturing:
            self._watch.warn()
        if state_in is not state_out:
            self._foreign.copy(state_in, state_out)
            wp.copy(state_edits(state_out), state_edits(state_in))
        self._reactions.collect(state_in, contacts, seconds)
        for body in self._simulated:
            body.step(state_in, state_out, seconds, targets)
        self._reactions.react(state_in, seconds)
        self._watch.note()

    def warm_up(self, *, progress: bool | None = None) -> None:
        """Compile and load every kernel that the scene can need, collisions and cuts included.

        Without it they are compiled when they are first launched: in the first step, contact or cut. Nothing that is
        simulated changes. Compiled kernels stay in Warp's cache, so it is quick the next time.

        Args:
            progress: Whether to show a bar; None for in a terminal.
        """
        if progress is not None:
            as_flag(progress, "progress, unless it is None,")
        warm_up(
            self.model,
            self._simulated,
            lambda state, other, contacts: self.step(state, other, None, contacts, 1.0e-4),
            progress=progress,
        )

    def begin_cut(self, body: int | str, blade: Blade) -> BodyCut:
        """Put a blade to a body; nothing changes before it advances.

        Args:
            body: Index or label of the body.
            blade: The blade, in the rest frame of the body's cage.

        Raises:
            ValueError: There is no such body, or it was added with cuttable=False.
        """
        self._stamps.raise_missed()
        return BodyCut(self._simulated[self._row(body)], blade)

    def advance_cut(
        self,
        cut: BodyCut,
        by: float | None = None,
        *,
        to: float | None = None,
        states: Sequence[newton.State] = (),
    ) -> CutReport:
        """Advance a cut: the model edit. A failed edit leaves model, states and weights as they were.

        Cuts of one body may advance in turn; ``cut.turn(direction)`` bends one at its present front. The model's own
        initial state follows: ``model.state()`` starts from rest as the body is then. A state that is not passed can
        no longer be stepped; see :meth:`step`.

        Args:
            cut: The cut.
            by: Length to advance by from where the cut is, in the rest frame [m].
            to: Depth to advance to instead, from where the blade first touches [m].
            states: All states in use; new cage vertices get their positions and velocities in each.

        Returns:
            What was done.

        Raises:
            TypeError: A length is not a number, or ``states`` are not states.
            ValueError: Neither or both of ``by`` and ``to`` are given, the cut would go back, the result does not fit
                the reserved capacity, or a state missed an earlier edit.
        """
        if (by is None) == (to is None):
            raise ValueError("advance_cut needs either a length to advance by or to=depth")
        self._own(as_instance(cut, BodyCut, "cut", hint="begin_cut(body, blade) returns one"), "cut")
        self._stamps.raise_missed()
        depth = to if by is None else cut.depth + as_number(by, "by, the length to advance by,")
        return cut.advance(depth, states)

    def snapshot(
        self, body: int | str = 0, *, states: Sequence[newton.State] = (), cuts: Sequence[BodyCut] = ()
    ) -> BodySnapshot:
        """Keep all that cuts of a body change, for :meth:`restore`; as many bytes as its walks and weights.

        Args:
            body: Index or label of the body.
            states: States whose rows of the body are to be brought back too.
            cuts: Cuts that are to go on from where they are; others must be begun anew after ``restore``.

        Raises:
            ValueError: There is no such body, or it was added with cuttable=False.
        """
        self._stamps.raise_missed()
        return BodySnapshot(self._simulated[self._row(body)], states, cuts)

    def restore(self, snapshot: BodySnapshot) -> None:
        """Undo every cut since a snapshot: cage, weights, surface, masses and the states' rows are as they were.

        All or nothing. States that the snapshot does not hold cannot be stepped any more, unless they are of that time.

        Args:
            snapshot: A snapshot of a body of this solver.

        Raises:
            TypeError: It is no snapshot.
            ValueError: It is of another solver, or the body was cut through one of the model meanwhile.
        """
        as_instance(snapshot, BodySnapshot, "snapshot", hint="solver.snapshot(body) returns one")
        self._own(snapshot, "snapshot")
        snapshot.restore()

    def surface(
        self, state: newton.State, body: int | str = 0, *, data: bool = False
    ) -> tuple[np.ndarray, np.ndarray] | tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """The surface of a body in a state.

        The mesh's own points come first, with their numbers; points that cuts have made come after them.

        Args:
            state: The state.
            body: Index or label of the body.
            data: Whether the arrays that were registered with the body are wanted, as they are now; see
                ``Surface.data``.

        Returns:
            Points in the world [m], shape (n, 3), float32, and triangles, shape (m, 3), int32; with ``data`` also
            arrays by name, of shapes (n, ...), (m, 3, ...) and (m, ...).
        """
        found, data = self._simulated[self._row(body)], as_flag(data, "data")
        points, triangles = found.surface_points(state).numpy().copy(), found.surface.triangles.astype(np.int32)
        if not data:
            return points, triangles
        return points, triangles, {name: array.copy() for name, array in found.surface.data.items()}

    def pieces(self, body: int | str = 0) -> tuple[BodyPiece, ...]:
        """The pieces that a body is in: vertices, faces, surface points and triangles, volume and mass of each.

        Args:
            body: Index or label of the body.

        Raises:
            ValueError: There is no such body.
        """
        return self.body(body).pieces

    def log(self, viewer: newton.viewer.ViewerBase, state: newton.State) -> None:
        """Show the surfaces in any Newton viewer, with the topology of this frame; caps have a colour of their own."""
        if not callable(getattr(viewer, "log_mesh", None)):
            raise TypeError(
                f"viewer must be a viewer of Newton's, such as newton.viewer.ViewerGL(), got {shown(viewer)}"
            )
        for body in self._simulated:
            self._viewer.log(viewer, body, state)

    def scene_frame(self, state: newton.State) -> SceneFrame:
        """What the scene looks like in a state: for ``AnimationWriter.write_frame(frame, solver, state)``.

        Args:
            state: The state.

        Raises:
            ValueError: The state missed an edit of a body.
        """
        if self._recorder is None:
            from .scene_recorder import SceneRecorder

            self._recorder = SceneRecorder(self.model, self._simulated)
        return self._recorder.frame(state)

    def statistics(self) -> list[dict[str, object]]:
        """How the steps of each body went, one record a body, read on the host.

        Each has its ``body`` and, of a body with elasticity: ``steps`` in all, of which ``refused`` could not be made,
        for the ``reason`` of the last; ``limited``, whose solution was not taken whole; ``stalled``, where it was not
        taken at all; ``missed``, where a solve ended short of the tolerance; ``iterations`` and ``residual`` of the
        last, ``most_iterations`` and ``worst_residual`` of all.
        """
        return self._watch.statistics()

    def plan(self) -> list[PlanEntry]:
        """What the scene uses, what was left out and why, and the bytes of each."""
        return [entry for body in self._simulated for entry in plan_of(body)] + plan_of_scene(self._stamps, self._watch)
