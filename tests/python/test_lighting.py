# SPDX-License-Identifier: Apache-2.0
"""The OpenCL half alone."""
import kilolux
import numpy as np
import pytest

CAMERA = {"position": (4.0, 2.5, 6.0), "focal_point": (0.0, 0.5, 0.0), "y_fov": np.radians(50)}
SIZE = (96, 64)


@pytest.fixture(scope="module")
def lights():
    random = np.random.default_rng(5)
    return kilolux.Lights(random.uniform((-4, 0, -4), (4, 3, 4), (300, 3)), random.uniform(0, 3, (300, 3)), 2.0)


@pytest.fixture(scope="module")
def frame(lights):
    return kilolux.render("grid", lights=lights, resolution=SIZE, camera_position=CAMERA["position"],
                          camera_focal_point=CAMERA["focal_point"], camera_view_angle=50, gbuffer="full",
                          shading="pbr", ambient=0, counts=True,
                          aov=["depth", "normal", "albedo", "roughness", "metallic", "emissive", "light-count"])


def gbuffer_of(frame, **other):
    aovs = frame.aovs
    planes = {name: aovs[name] for name in ("depth", "normal", "albedo", "roughness", "metallic", "emissive")}
    return kilolux.GBuffer(**{**planes, **CAMERA, **other})


def test_lights_the_surfaces_of_a_picture_as_the_renderer_does(frame, lights):
    lit = kilolux.GBufferLighting().light(gbuffer_of(frame), lights)
    assert lit.radiance.shape == (64, 96, 3) and lit.radiance.dtype == np.float32
    assert lit.radiance.max() > 0.1
    # The AOVs' depths are rounded, and dielectrics here reflect 4 %: the grid has some that do not.
    agree = np.isclose(lit.radiance, frame.radiance, rtol=1e-3, atol=1e-4).all(axis=2)
    assert agree.mean() > 0.9
    assert (lit.covering <= lit.evaluated).all() and lit.covering.max() > 0
    drawn = frame.aovs["depth"] > 0
    positions = np.asarray(lights.position)
    assert lit.evaluated[~drawn].max(initial=0) == 0 and lit.evaluated.max() <= len(positions)


def test_many_lights_without_a_range_keep_their_light(frame):
    """At most 128 such lights reach all pixels."""
    place = np.random.default_rng(6).uniform((-4, 0, -4), (4, 3, 4), (200, 3))
    lighting = kilolux.GBufferLighting()

    def lit(*groups):
        return lighting.light(gbuffer_of(frame), [kilolux.Lights(p, 0.01) for p in groups]).radiance

    glow = lit(place[:0])
    all_light = (lit(place[:100]) - glow).sum() + (lit(place[100:]) - glow).sum()
    assert (lit(place) - glow).sum() == pytest.approx(all_light, rel=0.1)


def test_counts_are_those_of_distances(frame, lights):
    """covering: within the range, from positions made here of depth and camera."""
    lit = kilolux.GBufferLighting(shading="lambert").light(gbuffer_of(frame), lights)
    eye, at = np.array(CAMERA["position"]), np.array(CAMERA["focal_point"])
    back = (eye - at) / np.linalg.norm(eye - at)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    height, width = 64, 96
    tan = np.tan(CAMERA["y_fov"] / 2)
    y, x = np.mgrid[0:height, 0:width]
    rays = ((2 * (x + 0.5) / width - 1)[..., None] * right * tan * width / height
            + (1 - 2 * (y + 0.5) / height)[..., None] * up * tan - back)
    drawn = frame.aovs["depth"] > 0
    points = eye + rays * frame.aovs["depth"][..., None]
    distance = np.linalg.norm(points[..., None, :] - np.asarray(lights.position), axis=3)
    sure = (distance < 2.0 * (1 - 1e-4)).sum(axis=2)
    most = (distance < 2.0 * (1 + 1e-4)).sum(axis=2)
    assert sure[drawn].max() > 3
    assert (lit.covering[drawn] >= sure[drawn]).all() and (lit.covering[drawn] <= most[drawn]).all()


def test_all_kinds_of_lights_and_no_background(lights):
    plane = kilolux.GBuffer(np.full((20, 30), 2.0), [0, 0, 1] * np.ones((20, 30, 3)), np.ones((20, 30, 3)),
                            position=(0, 0, 2), focal_point=(0, 0, 0))
    lighting = kilolux.GBufferLighting(shading="lambert")
    sun = kilolux.Lights([[0, 0, 0]], 2.0, direction=(0, 0, -1), kind="directional")
    np.testing.assert_allclose(lighting.light(plane, sun, ambient=0.5).radiance, 2.0 / np.pi + 0.5, rtol=1e-5)
    spot = kilolux.Lights([[0, 0, 1]], 1.0, 3.0, direction=(0, 0, -1), outer_cone=0.3, kind="spot")
    radiance = lighting.light(plane, [spot]).radiance
    assert radiance[10, 15, 0] > 0.2 and radiance[0, 0].max() == 0
    assert lighting.light(plane, []).radiance.max() == 0
    empty = kilolux.GBuffer(np.zeros((20, 30)), plane.normal, plane.albedo, position=(0, 0, 2), focal_point=(0, 0, 0))
    assert lighting.light(empty, lights).radiance.max() == 0


@pytest.mark.parametrize("other, words", [
    ({"depth": np.ones(5)}, r"depth has the shape \(5,\)"),
    ({"normal": np.ones((64, 96))}, r"normal has the shape \(64, 96\), must be \(64, 96, 3\)"),
    ({"roughness": np.ones((3, 3))}, "roughness has the shape"),
    ({"focal_point": CAMERA["position"]}, "."),
])
def test_bad_planes_are_refused(frame, lights, other, words):
    with pytest.raises(kilolux.Error, match=words):
        kilolux.GBufferLighting().light(gbuffer_of(frame, **other), lights)


def test_bad_choices_are_refused():
    with pytest.raises(kilolux.Error, match="shading 'toon' is none of"):
        kilolux.GBufferLighting(shading="toon")
    with pytest.raises(kilolux.Error, match="no such device"):
        kilolux.GBufferLighting(device="no such device")


@pytest.mark.parametrize("other, words", [
    ({"position": (0, 1)}, r"position: \(0, 1\) is not three finite numbers"),
    ({"y_fov": 50}, "y_fov .* 50 is not a number from"),  # degrees
    ({"albedo": np.where(np.arange(64 * 96 * 3).reshape(64, 96, 3) < 3 * 96 * 40, 1, np.nan)},
     r"albedo of pixel \d+,\d+ is \[nan nan nan\], must be finite"),
    ({"normal": np.zeros((64, 96, 3))}, "normal of pixel .* has no direction"),
    ({"depth": [["far"]]}, "depth: could not convert string to float"),
    ({"depth": np.empty((0, 4))}, "depth has no pixels"),
])
def test_values_that_would_give_a_wrong_picture_are_refused(frame, lights, other, words):
    with pytest.raises(kilolux.Error, match=words) as caught:
        kilolux.GBufferLighting().light(gbuffer_of(frame, **other), lights)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("given, kind", [(5, "int"), (None, "NoneType"), (np.zeros((2, 3)), "ndarray"), ("all", "str")])
def test_lights_of_no_kind_are_refused(frame, given, kind):
    with pytest.raises(kilolux.Error, match=f"lights: must be Lights or a list of them, not .*{kind}"):
        kilolux.GBufferLighting().light(gbuffer_of(frame), given)


def test_normals_have_any_length(frame, lights):
    lighting = kilolux.GBufferLighting(device=0)
    once = lighting.light(gbuffer_of(frame), lights).radiance
    longer = lighting.light(gbuffer_of(frame, normal=4 * frame.aovs["normal"]), lights).radiance
    assert once.max() > 0.1
    np.testing.assert_array_equal(once, longer)
