"""The wavefront's decisions on balls: what cannot be decided is bounded and named.

`Balls` answers the same questions as `Floats`. Where the nearest object or total reflection is
undecided, the colour of that ray is only known to lie between the darkest and the brightest colour that any
ray of its generation can have; the weights on the way to the eye shrink that bound.
"""

from __future__ import annotations

from typing import Any

from reference_tracer.formulas.plane import NEVER
from reference_tracer.lanes.backend import Backend
from reference_tracer.lanes.ball import INFINITY, UNDERFLOW_32, UNDERFLOW_64, Ball, Doubtful, Precision
from reference_tracer.lanes.floats import Nearest
from reference_tracer.lanes.span import colours
from reference_tracer.numbers import select
from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec
from scenes.model import Scene

HIT = 1
SMALL = 1e-100
"""Scene numbers below this are not trusted to multiply without underflow."""


class Balls:
    """Balls at unit roundoff u.

    ball: the kind of ball; scene, rules: for the span of each generation's colours; single: the tracer
    reads a scene's numbers into float32; offset: how far from its start a ray may lawfully fail to see a surface.
    """

    def __init__(
        self,
        u: float,
        scene: Scene,
        rules: Rulebook,
        lanes: Backend,
        single: bool,
        offset: float,
        ball: Any = Ball,
    ) -> None:
        self.ball = ball
        tiny = UNDERFLOW_32 if single else UNDERFLOW_64
        self.precision = Precision(lanes.scalar(u), lanes.scalar(tiny))
        self.inputs = lanes.to_single if single else _as_given
        self.offset = lanes.scalar(offset)
        # Who needs no offset knows where its rays start
        self.beyond = lanes.scalar(offset if offset > 0.0 else NEVER)
        self.spans = [
            [(lanes.scalar(low), lanes.scalar(top)) for low, top in channels] for channels in colours(scene, rules, u)
        ]

    def read(self, array: Any) -> Any:
        """A number of the scene as the tracer reads it; one that nearly underflows counts as unknown."""
        gap = array - self.inputs(array)
        size = select(array < 0.0, -array, array)
        rad = select(gap < 0.0, -gap, gap)
        return self.ball(array, select((size < SMALL) & (array != 0.0), size + SMALL, rad), self.precision)

    def exact(self, array: Any) -> Any:
        return self.ball(array, array - array, self.precision)

    def start(self) -> Any:
        return self.ball(0.0, self.offset, self.precision)

    def fresh(self, o: Vec, v: Vec) -> tuple[Vec, Vec]:
        begun: tuple[Vec, Vec] = self.ball.begin(o, v)
        return begun

    def again(self) -> Any:
        return self.ball(self.beyond, 0.0, self.precision)

    def surely(self, condition: Doubtful) -> Any:
        return condition.value & condition.sure

    def matters(self, colour: Vec) -> Any:
        """Where a midpoint is not 0: elsewhere the ball holds black already."""
        return (colour.x.mid != 0.0) | (colour.y.mid != 0.0) | (colour.z.mid != 0.0)

    def possible(self, weight: Vec) -> Any:
        """Where a weight is not exactly 0."""
        x, y, z = (part if hasattr(part, "rad") else self.exact(part) for part in weight)
        somewhere = (x.mid != 0.0) | (y.mid != 0.0) | (z.mid != 0.0)
        return somewhere | (x.rad != 0.0) | (y.rad != 0.0) | (z.rad != 0.0)

    def none_yet(self, real: Any, integer: Any) -> Any:
        """Best hit, its row, whether it certainly exists, and the nearest that might beat it."""
        no = integer != 0
        return (self.ball(real + INFINITY, real, self.precision), integer - 1, no, real + INFINITY)

    def consider(self, state: Any, rules: Rulebook, distance: Any, meets: Doubtful, row: Any) -> Any:
        best, best_row, certain, rival = state
        wins = meets.value & ((best_row < 0) | rules.nearer(distance.mid, best.mid, row, best_row))
        # The loser of this comparison may still be nearer than the final best: keep the least such bound
        beaten = select(best_row < 0, INFINITY, lower_end(best))
        loser = select(wins, beaten, select(meets.possible, lower_end(distance), INFINITY))
        rival = select(loser < rival, loser, rival)
        return (
            select(wins, distance, best),
            select(wins, row, best_row),
            select(wins, meets.sure, certain),
            rival,
        )

    def settle(self, state: Any) -> tuple[Nearest, Any]:
        best, row, certain, rival = state
        found = row >= 0
        decided = (found & certain & (best.upper < rival)) | ~(found | (rival < INFINITY))
        none = row - row
        return Nearest(best, row), select(decided, none, none + HIT)

    def doubt(self, doubts: Any, kind: int, condition: Doubtful, matters: Any) -> Any:
        none = doubts - doubts
        return doubts | select(matters & ~condition.sure, none + kind, none)

    def bounded(self, colour: Vec, doubts: Any, generation: int) -> Vec:
        lost = (doubts & HIT) > 0
        return Vec(*(self._clip(c, lost, *span) for c, span in zip(colour, self.spans[generation], strict=True)))

    def join(self, doubts: Any, *others: Any) -> Any:
        for other in others:
            doubts = doubts | other
        return doubts

    def _clip(self, colour: Any, lost: Any, low: Any, top: Any) -> Any:
        """The ball cut to [low, top]; all of it where lost. It forgets its symbols: no two branches share new ones."""
        above, below = top - colour.mid, colour.mid - low
        room = select(below > above, below, above)
        known = ~lost & (colour.rad < room)
        return self.ball(colour.mid, select(known, colour.rad, room), self.precision)


def _as_given(array: Any) -> Any:
    return array


def lower_end(ball: Any) -> Any:
    """At most every value of the ball; -inf where nothing is known of it."""
    lower = ball.lower
    return select(lower == lower, lower, -INFINITY)
