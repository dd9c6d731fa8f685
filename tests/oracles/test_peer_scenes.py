"""Our scenes in other renderers' words."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from oracles.peers.cannot import CannotSayError
from oracles.peers.frames import plane_frame
from oracles.peers.mitsuba_xml import is_stochastic, one_light_each, to_mitsuba
from oracles.peers.povray_scene import channels, to_povray
from scenes.catalogue import ladder, rung
from scenes.model import Plane

SHARED = ("background", "glass-fresnel", "physical-lights", "mirror-chain")

U = 2.0**-53


@pytest.mark.parametrize("name", SHARED)
def test_a_shared_scene_is_well_formed_xml_with_a_shape_an_object(name: str) -> None:
    scene = rung(name).scene()
    root = ET.fromstring(to_mitsuba(scene))  # noqa: S314 (our own text)
    assert len(root.findall("shape")) == len(scene.objects)
    assert root.attrib["version"].startswith("3.")


@pytest.mark.parametrize("name", [entry.name for entry in ladder() if entry.name not in SHARED])
def test_a_scene_of_the_lectures_own_model_is_refused_with_a_reason(name: str) -> None:
    with pytest.raises(CannotSayError, match=r"\w{4}"):
        to_mitsuba(rung(name).scene())


@pytest.mark.parametrize("name", ["fresnel-window", "inside-glass"])
def test_an_eye_inside_glass_is_refused_since_radiance_differs_there(name: str) -> None:
    scene = rung(name).scene()
    white = {"ambient": (0.0, 0.0, 0.0), "reflect": (1.0, 1.0, 1.0), "transmit": (1.0, 1.0, 1.0)}
    materials = {
        key: m.model_copy(update=white if any(m.transmit) else {"diffuse": (0.0, 0.0, 0.0)})
        for key, m in scene.materials.items()
    }
    with pytest.raises(CannotSayError, match="inside glass"):
        to_mitsuba(scene.model_copy(update={"fresnel": True, "materials": materials}))


def test_lights_are_pi_times_as_strong_since_mitsubas_diffuse_divides_by_pi() -> None:
    scene = rung("physical-lights").scene()
    root = ET.fromstring(to_mitsuba(scene))  # noqa: S314
    rgb = root.find("emitter[@type='directional']/rgb")
    assert rgb is not None
    assert [float(x) for x in rgb.attrib["value"].split()] == [np.pi * x for x in scene.lights[0].color]


def test_only_glass_leaves_a_path_tracer_to_chance() -> None:
    assert [name for name in SHARED if is_stochastic(rung(name).scene())] == ["glass-fresnel"]


def test_lights_are_rendered_one_by_one() -> None:
    parts = one_light_each(rung("physical-lights").scene())
    assert [len(part.lights) for part in parts] == [1, 1]


@pytest.mark.parametrize("normal", [(0.0, 1.0, 0.0), (1.0, 2.0, -3.0), (0.1234, 0.0187, -1.0)])
def test_a_planes_disk_lies_in_the_plane_with_its_normal(normal: tuple[float, float, float]) -> None:
    frame = plane_frame(Plane(shape="plane", normal=normal, offset=-2.5, material="m"))
    n = np.array(normal)
    for x, y in ((0, 0), (1e-7, 0), (0, -1e-7)):
        p = (frame @ [x, y, 0, 1])[:3]
        # p is rounded at its own size, and was made of unit vectors that are some u off
        assert n @ p == pytest.approx(-2.5, abs=16 * U * np.abs(n).sum() * np.abs(p).max())
    assert frame[:3, 2] == pytest.approx(n / np.linalg.norm(n), abs=4 * U)
    assert np.linalg.det(frame[:3, :3]) > 0


@pytest.mark.parametrize("name", [entry.name for entry in ladder()])
def test_povray_can_say_every_scene_at_most_a_channel_at_a_time(name: str) -> None:
    for part in channels(rung(name).scene()):
        assert to_povray(part).count("{") == to_povray(part).count("}")


def test_coloured_glass_needs_three_pictures_and_povray_says_why() -> None:
    scene = rung("reflect-and-refract").scene()
    assert len(channels(scene)) == 3
    with pytest.raises(CannotSayError, match="a colour of its own"):
        to_povray(scene)


def test_an_index_inside_glass_is_multiplied_by_that_of_the_glass() -> None:
    """POV-Ray's indices are absolute: a bubble of 1/1.5 in glass of 1.5 is air."""
    text = to_povray(channels(rung("air-bubble").scene())[0])
    assert "ior 1.5 " in text
    assert "ior 1.0 " in text
