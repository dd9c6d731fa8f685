"""The wavefront: the recursion of the plain tracer, a whole generation of rays at a time.

L11 "Ray Tracing has three features": rays that go astray or carry the weight 0
are removed before the next generation; the colours come back up the same way.
Every ray writes its own slot, so the result does not depend on any order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from reference_tracer.formulas import optics
from reference_tracer.lanes.backend import Array, Backend, each
from reference_tracer.lanes.floats import Nearest, Numbers
from reference_tracer.lanes.tables import Tables
from reference_tracer.numbers import less, select
from reference_tracer.rulebook import Rulebook, last
from reference_tracer.vector import Vec, select_vec
from scenes.model import Scene

HIT, SHADOW, CRITICAL, TERMINATOR = 1, 2, 4, 8
"""Kinds of decisions that can be in doubt: which object, visibility, total reflection, i·n > 0."""


class Rays(NamedTuple):
    """One generation: origins, unit directions, and the row each starts on (-1: the eye)."""

    o: Vec
    v: Vec
    start: Array


class Surface(NamedTuple):
    """Where the rays of a generation arrived: point, facing normal, side, object's row."""

    p: Vec
    n: Vec
    leaving: Any
    row: Array


@dataclass(frozen=True)
class Wavefront:
    """One scene on one backend; `numbers` decides what a lane's number is.

    other_branches: what to make of rays whose nearest object is in doubt; nothing unless given.
    """

    scene: Scene
    rules: Rulebook
    backend: Backend
    numbers: Numbers
    tables: Tables
    other_branches: Callable[..., tuple[Vec, Any]] | None = None

    def colours(self, pixel: Array) -> tuple[Vec, Any]:
        """Colours of these pixels, counted row by row, and the doubts about them."""
        return self.trace(self.eye_rays(pixel), 0)

    def eye_rays(self, pixel: Array) -> Rays:
        """Generation 0: one ray a pixel."""
        width = self.scene.image.width
        j = pixel // width
        i = pixel - j * width
        x, y = (self.numbers.exact(self.backend.to_real(index)) for index in (i, j))
        w, h, *sample = self._packet("image", 0)
        X, Y = self.rules.plane_point(x, y, w, h, sample)
        v = self.rules.camera_ray(self._view("forward"), self._view("right"), self._view("up"), X, Y)
        eye = self._view("eye")
        at_eye = each(eye, lambda array: array + self.backend.to_real(pixel - pixel))
        return Rays(at_eye, v, pixel - pixel - 1)

    def first_hits(self, begin: int, end: int) -> tuple[Array, Vec, Array]:
        """Distance, outward normal and row of what the eye rays of these pixels meet; inf, 0 and -1 for nothing."""
        rays = self.eye_rays(self.backend.indices(begin, end))
        nearest, _ = self.nearest(rays)
        hit = nearest.row >= 0
        row = select(hit, nearest.row, rays.start - rays.start)
        normal = self._normal(rays.o + rays.v * select(hit, nearest.distance, 1.0), row)
        black = each(normal, lambda array: self.backend.zeros(array))
        return nearest.distance, select_vec(hit, normal, black), nearest.row

    def trace(self, rays: Rays, generation: int) -> tuple[Vec, Any]:
        """Colours of these rays and of all that follows from them. The plain tracer's find_rgb."""
        rays = Rays(*self.numbers.fresh(rays.o, rays.v), rays.start)
        self.backend.evaluate(tuple(rays))
        nearest, doubts = self.nearest(rays)
        if self.other_branches is None:
            return self.follow(rays, nearest, doubts, generation)
        return self.other_branches(self, rays, nearest, doubts, generation)

    def follow(self, rays: Rays, nearest: Nearest, doubts: Any, generation: int) -> tuple[Vec, Any]:
        """Colours of rays whose nearest object is known."""
        # Shade; one kernel serves every generation of every scene
        surface, hit, local, doubts = self.arrive(rays, nearest, doubts, generation)
        _, total = self._refract(rays.v, surface)
        reflect, transmit = self._weights(rays.v, surface, total)
        reflects = hit & self.numbers.possible(reflect)
        transmits = hit & self.numbers.possible(optics.cut(total, transmit))
        unsure = self.numbers.doubt(doubts, CRITICAL, total, hit & self._transmits(surface.row))
        self.backend.evaluate((local, doubts, unsure, *surface, hit, total, reflects, transmits))
        if generation == self.rules.generations(self.scene.depth):
            beyond = self.background()
            ended = self.rules.last(local, reflect, beyond, transmit, optics.cut(total, beyond))
            found = self.rules.seen(select_vec(hit, ended, local))
            return self.numbers.bounded(found, doubts, generation), doubts if self.rules.last is last else unsure

        # Trace the rays whose weight is not 0, and bring their colours back to where they came from
        up, down = self.backend.compress(reflects), self.backend.compress(transmits)
        mirrored, refracted = self.backend.width(up), self.backend.width(down)
        reflected = transmitted = each(local, lambda array: self.backend.zeros(array))
        passed_on = unsure
        if mirrored + refracted > 0:
            colour, child_doubts = self.trace(self._children(rays, surface, up, down), generation + 1)
            lanes = self.backend.width(surface.row)
            to_up = self.backend.positions(lanes, up, 0)
            to_down = self.backend.positions(lanes, down, mirrored)
            reflected = self._back(colour, to_up)
            transmitted = optics.cut(total, self._back(colour, to_down))
            passed_on = self.numbers.join(unsure, self._back(child_doubts, to_up), self._back(child_doubts, to_down))

        # Weigh the branches; a ray without any keeps its local colour
        reflect, transmit = self._weights(rays.v, surface, total)
        blended = self.rules.mix(local, reflect, reflected, transmit, transmitted)
        found = self.rules.seen(select_vec(hit, blended, local))
        result = self.numbers.bounded(found, doubts, generation)
        self.backend.evaluate((result, passed_on))
        return result, passed_on

    def arrive(self, rays: Rays, nearest: Nearest, doubts: Any, generation: int) -> tuple[Surface, Array, Vec, Any]:
        """The nearest surface of each ray, whether there is one, and its local colour."""
        hit = nearest.row >= 0
        row = select(hit, nearest.row, rays.start - rays.start)
        distance = select(hit, nearest.distance, 1.0)
        p = rays.o + rays.v * distance
        normal = self._normal(p, row)
        n, leaving = self.rules.face(rays.v, normal)
        surface = Surface(p, n, leaving, row)
        lit, doubts = self.local_colour(rays.v, surface, hit, doubts)
        return surface, hit, select_vec(hit, lit, self.stray(generation)), doubts

    def over_objects(self, rays: Rays, step: Callable[[Any, Any, Any, Any], Any], state: Any) -> Any:
        """State = step(state, distance, meets, row) over all objects, asked of these rays."""

        def met(row: Any, meet: Callable[..., Any], state: Any) -> Any:
            distance, meets = meet(row, rays.o, rays.v, rays.start)
            return step(state, distance, meets, row)

        return self._over_objects(met, state, lambda state: rays.start == rays.start)

    def meet_row(self, rays: Rays, row: Array) -> Any:
        """Distance along each ray to the object of its row, met or not."""
        round_, _ = self._meet_sphere(row, rays.o, rays.v, rays.start)
        flat, _ = self._meet_plane(row, rays.o, rays.v, rays.start)
        return select(row < self.backend.count(self.tables.spheres), round_, flat)

    def nearest(self, rays: Rays) -> tuple[Nearest, Any]:
        """The first object along each ray."""

        def step(state: Any, distance: Any, meets: Any, row: Any) -> Any:
            return self.numbers.consider(state, self.rules, distance, meets, row)

        integer = rays.start - rays.start
        state = self.numbers.none_yet(self.backend.to_real(integer), integer)
        return self.numbers.settle(self.over_objects(rays, step, state))

    def shadowed(self, p: Vec, i: Vec, light_distance: Any, start: Array, lit: Array) -> Any:
        """Does anything stand strictly between p and the light? Asked only where it is lit."""

        def step(row: Any, meet: Callable[..., Any], state: Any) -> Any:
            distance, meets = meet(row, p, i, start)
            return (state[0] | (meets & self.rules.blocks(distance, light_distance, ~self._transmits(row))),)

        nothing = less(self.numbers.exact(self.backend.to_real(start - start)), -1.0)
        wanted = self.scene.shadows
        return self._over_objects(step, (nothing,), lambda state: lit & ~self.numbers.surely(state[0]), wanted)[0]

    def _over_objects(
        self, step: Callable[..., Any], state: Any, wanted: Callable[[Any], Array], some: bool = True
    ) -> Any:
        """Fold over all spheres, then over all planes; over none unless `some`."""
        spheres = self.backend.count(self.tables.spheres * some)
        planes = self.backend.count(self.tables.planes * some)
        state = self.backend.fold(spheres, lambda k, s: step(k, self._meet_sphere, s), state, wanted)
        return self.backend.fold(planes, lambda k, s: step(k + spheres, self._meet_plane, s), state, wanted)

    def _meet_sphere(self, row: Any, o: Vec, v: Vec, start: Array) -> tuple[Any, Any]:
        c, r = self._geometry(row)
        return self.rules.sphere_hit(self.rules.sphere_distances, o, v, c, r, start == row, self.numbers.start())

    def _meet_plane(self, row: Any, o: Vec, v: Vec, start: Array) -> tuple[Any, Any]:
        normal, offset = self._geometry(row)
        begin, again = self.numbers.start(), self.numbers.again()
        return self.rules.plane_hit(o, v, normal, offset, start != row, begin, again)

    def _normal(self, p: Vec, row: Array) -> Vec:
        geometry, _ = self._geometry(row)
        round_ = self.rules.sphere_normal(p, geometry)
        flat = self.rules.plane_normal(geometry)
        return select_vec(row < self.backend.count(self.tables.spheres), round_, flat)

    def local_colour(self, v: Vec, surface: Surface, hit: Array, doubts: Any) -> tuple[Vec, Any]:
        """Ambient, and the diffuse and specular light of every lamp in view."""
        rules, row = self.rules, surface.row
        n = rules.shading_normal(surface.n, surface.leaving)
        ambient = self._vec("ambient", row)
        diffuse, specular = self._vec("diffuse", row), self._vec("specular", row)
        shininess = self._integer("shininess", row)
        v = rules.view_vector(v, surface.p, self._view("eye"))

        def step(k: Any, state: Any) -> Any:
            colour, doubts = state
            is_point = self._integer("is_point", k) > 0
            kind = self._integer("attenuation", k)
            i, distance = rules.light_vector(self._vec("light", k), surface.p, is_point)
            factor = rules.attenuation(distance, kind == 1, kind == 2)
            cosine = rules.lambert(i, n)
            gloss = rules.phong(i, n, v, shininess, rules.reflect(i, n))
            terms = (self._vec("color", k), factor, diffuse, cosine, specular, gloss)
            share, shaded = rules.direct_light(*terms), rules.shaded_light(*terms)
            lit = hit & self.numbers.matters(share)
            blocked = self.shadowed(surface.p, i, distance, row, lit)
            doubts = self.numbers.doubt(doubts, SHADOW, blocked, lit)
            hidden = Vec(*(select(blocked, dark, part) for dark, part in zip(shaded, share, strict=True)))
            return (rules.add_light(colour, select_vec(lit, hidden, share), ambient, terms[0]), doubts)

        lights = self.backend.count(self.tables.lights)
        colour, doubts = self.backend.fold(lights, step, (rules.ambient_light(ambient), doubts), lambda state: hit)
        return colour, doubts

    def _refract(self, v: Vec, surface: Surface) -> tuple[Vec, Any]:
        return self.rules.refract(v, surface.n, surface.leaving, self._index(surface.row))

    def _weights(self, v: Vec, surface: Surface, total: Any) -> tuple[Vec, Vec]:
        """What the branches count for."""
        return self.rules.weights(
            self._vec("reflect", surface.row),
            self._vec("transmit", surface.row),
            total,
            self.scene.fresnel,
            lambda: self.rules.fresnel(v, surface.n, surface.leaving, self._index(surface.row)),
        )

    def _transmits(self, row: Any) -> Any:
        """Where the object of a row is transparent."""
        return self._integer("transmits", row) > 0

    def _children(self, rays: Rays, surface: Surface, up: Array, down: Array) -> Rays:
        """The next generation: first the reflected rays, then the refracted ones."""
        parent = self.backend.concatenate(up, down)
        child = self.backend.indices(0, self.backend.width(parent))
        v, from_surface = (each(part, lambda a: self.backend.gather(a, parent)) for part in (rays.v, tuple(surface)))
        at = Surface(*from_surface)
        r = self.rules.mirror(-v, at.n)
        t, _ = self._refract(v, at)
        return Rays(at.p, select_vec(child < self.backend.width(up), r, t), at.row)

    def _back(self, state: Any, position: Array) -> Any:
        """What each ray gets from its child at `position`; 0 where it has none."""
        return each(state, lambda array: self.backend.gather_or_zero(array, position))

    def _geometry(self, row: Any) -> tuple[Vec, Any]:
        """Centre and radius of a sphere, normal and offset of a plane."""
        x, y, z, size = self._packet("geometry", row)
        return Vec(x, y, z), size

    def _index(self, row: Any) -> Any:
        return self._packet("transmit", row)[3]

    def _vec(self, name: str, row: Any) -> Vec:
        return Vec(*self._packet(name, row)[:3])

    def _packet(self, name: str, row: Any) -> list[Any]:
        return [self.numbers.read(part) for part in self.backend.packet(self.tables.packets[name], row)]

    def _integer(self, name: str, row: Any) -> Any:
        return self.backend.gather(self.tables.integers[name], row)

    def background(self) -> Vec:
        """The scene's background."""
        return self._view("background")

    def stray(self, generation: int) -> Vec:
        """What a ray of that generation brings that meets nothing."""
        return self.rules.stray(self.background(), generation)

    def _view(self, name: str) -> Vec:
        return self._vec(name, 0)
