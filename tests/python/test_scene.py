# SPDX-License-Identifier: Apache-2.0
"""Scenes from arrays."""
import kilolux
import numpy as np
import pytest

VIEW = {"resolution": (64, 64), "camera_position": (0, 3, 0.001), "camera_focal_point": (0, 0, 0),
        "camera_view_up": (0, 0, -1), "ambient": 0, "shading": "lambert"}
LIGHT = kilolux.Lights([[0.0, 1.0, 0.0]], intensity=(3.0, 2.0, 1.0), range=4.0)


def lambert(position, albedo):
    """Radiance at points of the floor below LIGHT, by the falloff that the documents state."""
    d = np.sqrt(1.0 + position[..., 0] ** 2 + position[..., 2] ** 2)
    falloff = np.clip(1.0 - (d / 4.0) ** 4, 0.0, 1.0) / d**2 * (1.0 / d)
    return albedo / np.pi * falloff[..., None] * np.array([3.0, 2.0, 1.0])


@pytest.mark.parametrize("albedo", [(0.5, 0.25, 1.0), (1.0, 1.0, 1.0)])
def test_a_floor_is_lit_as_the_formula_says(floor, albedo):
    positions, indices = floor
    mesh = kilolux.Mesh(positions, indices, material=kilolux.Material(base_color=albedo))
    frame = kilolux.render(kilolux.Scene([mesh], LIGHT), aov=["position", "normal"], gbuffer="full", **VIEW)
    drawn = np.abs(frame.aovs["position"]).max(axis=2) > 0
    assert drawn.sum() > 1000
    np.testing.assert_allclose(frame.aovs["normal"][drawn], [[0, 1, 0]] * drawn.sum(), atol=1e-6)
    expected = lambert(frame.aovs["position"].astype(np.float64), np.array(albedo))
    np.testing.assert_allclose(frame.radiance[drawn], expected[drawn], rtol=2e-5, atol=1e-6)
    assert frame.stats["lights"]["given"] == 1


def test_a_mesh_without_a_material_is_white_and_no_metal(floor):
    positions, indices = floor
    scene = kilolux.Scene([kilolux.Mesh(positions, indices)] * 2, LIGHT)
    frame = kilolux.render(scene, aov=["depth", "albedo", "metallic", "roughness"], gbuffer="full",
                           **(VIEW | {"shading": "pbr"}))
    drawn = frame.aovs["depth"] > 0
    assert drawn.sum() > 1000
    for layer, value in (("albedo", 1.0), ("metallic", 0.0), ("roughness", 1.0)):
        np.testing.assert_allclose(frame.aovs[layer][drawn], value, atol=1e-6, err_msg=layer)


def test_normals_texcoords_colors_and_images(floor):
    positions, indices = floor
    image = np.zeros((8, 8, 3), np.uint8)
    image[:4, :4] = (255, 0, 0)
    image[4:, 4:] = (0, 0, 255)
    material = kilolux.Material(base_color_image=image, double_sided=True)
    mesh = kilolux.Mesh(positions, indices, normals=[[0, 2, 0]] * 4, texcoords=[[0, 0], [0, 1], [1, 1], [1, 0]],
                        colors=[[0.5, 1, 1]] * 4, material=material)
    frame = kilolux.render(kilolux.Scene([mesh], LIGHT), aov="albedo", gbuffer="full", **VIEW)
    corners = frame.aovs["albedo"][[16, 48], [16, 48]]
    np.testing.assert_allclose(corners, [[0.5, 0, 0], [0, 0, 1]], atol=0.06)


def test_meshes_are_placed_and_share_materials(floor):
    positions, indices = floor
    material = kilolux.Material(emissive=(1, 2, 3), unlit=False)
    lift = np.eye(4)
    lift[:3, 3] = (0, -1, 0)
    meshes = [kilolux.Mesh(positions, indices, material=material, world_from_object=lift),
              kilolux.Mesh(positions, indices, material=material)]
    scene = kilolux.Scene(meshes, name="two floors")
    frame = kilolux.render(scene, aov=["position", "emissive"], rig="none", **VIEW)
    assert frame.aovs["position"][32, 32, 1] == pytest.approx(0.0, abs=1e-5)
    np.testing.assert_allclose(frame.aovs["emissive"][32, 32], [1, 2, 3], rtol=0.02)
    alone = kilolux.render(kilolux.Scene(meshes[:1]), aov=["position"], rig="none", **VIEW)
    assert alone.aovs["position"][32, 32, 1] == pytest.approx(-1.0, abs=1e-5)


def test_emissive_surfaces_light_where_asked(floor):
    positions, indices = floor
    lamp = 0.01 * np.array(positions)  # 4 cm, 1 m above the floor, facing it
    lamp[:, 1] = 1.0
    meshes = [kilolux.Mesh(positions, indices, material=kilolux.Material(base_color=(1, 1, 1))),
              kilolux.Mesh(lamp, np.array(indices)[:, ::-1], material=kilolux.Material(emissive=(500, 250, 100)))]

    def lights(scene, **options):
        return kilolux.render(scene, rig="none", **VIEW, **options).stats["lights"]["given"]

    dark, lit = kilolux.Scene(meshes), kilolux.Scene(meshes, LIGHT)
    assert [lights(dark, emissive_lights=choice) for choice in ("off", "auto", "on")] == [0, 1, 1]
    assert [lights(lit, emissive_lights=choice) for choice in ("off", "auto", "on")] == [1, 1, 2]
    assert [lights(dark), lights(dark, shadows="exact"), lights(lit)] == [1, 0, 1]
    with pytest.raises(kilolux.Error, match="--emissive-lights: 'maybe'"):
        kilolux.render(dark, emissive_lights="maybe")
    with pytest.raises(kilolux.Error, match="shadows exact"):
        kilolux.render(dark, emissive_lights="on", shadows="exact", rig="none", **VIEW)
    renderer = kilolux.Renderer(dark, rig="none", emissive_lights="off", **VIEW)
    assert renderer.render().radiance[32, 32].max() == 0
    renderer.change(emissive_lights="on")
    # A small lamp straight above: albedo / pi * luminance * area / distance^2.
    expected = np.array([500, 250, 100]) * 0.04**2 / np.pi
    np.testing.assert_allclose(renderer.render().radiance[32, 32], expected, rtol=0.01)


@pytest.mark.parametrize("mesh, words", [
    ({"indices": [[0, 1, 4]]}, "indices from 0 to 4, but there are 4 positions"),
    ({"indices": [[0, 1, 4]], "normals": [[0, 1, 0]] * 4}, "index 2 is 4, but there are 4 positions"),
    ({"normals": [[0, 1, 0]] * 3}, r"normals: shape \(3, 3\), must be \(4, 3\)"),
    ({"positions": [[0, 0, 0], [0, 0, np.nan], [1, 0, 0], [1, 0, 1]]}, "positions: value 5 is nan"),
    ({"texcoords": [[0, 0, 0]] * 4, "normals": [[0, 1, 0]] * 4}, "texcoords: shape"),
    ({"indices": np.empty((0, 3), int)}, "has no triangles"),
    ({"world_from_object": np.eye(3)}, "world_from_object must have the shape"),
    ({"world_from_object": np.full((4, 4), np.nan)}, "world_from_object must .* be finite"),
    ({"indices": [[0, 1, 2.5]]}, "indices: are float64, must be integers"),
    ({"indices": [0, 1, 2]}, r"indices: shape \(3,\), must be \(n, 3\)"),
    ({"positions": [[0, 0]] * 4}, r"positions: shape \(4, 2\), must be \(n, 3\)"),
    ({"colors": [[1, 1, 1]] * 3}, "colors: 3 rows, but there are 4 positions"),
    ({"material": "red"}, "material must be a Material, not str"),
    ({"material": kilolux.Material(roughness=2)}, "roughness: 2 is not a number from 0 to 1"),
    ({"material": kilolux.Material(base_color=(1, 1))}, "base_color: .* is not three finite numbers"),
    ({"material": kilolux.Material(base_color_image=np.ones((2, 2, 3)))}, "base_color_image: values are float64"),
    ({"material": kilolux.Material(base_color_image=np.zeros((2, 2), np.uint8))}, "image of 'material': shape"),
])
def test_bad_meshes_are_refused_in_one_line(floor, mesh, words):
    positions, indices = floor
    with pytest.raises(kilolux.Error, match=words) as caught:
        kilolux.Scene([kilolux.Mesh(**{"positions": positions, "indices": indices, **mesh})])
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("lights, words", [
    ({"position": [0, 1]}, r"position has the shape \(2,\), must be \(n, 3\)"),
    ({"position": [["a", 0, 1]]}, "position: could not convert"),
    ({"range": [1, 2, 3]}, r"lights: range has the shape \(3,\), must be \(2,\) or one for all"),
    ({"intensity": [1, 2, 3, 4]}, r"lights: intensity has the shape \(4, 1\), must be \(2, 3\)"),
    ({"direction": [[0, 1], [1, 0]]}, r"lights: direction has the shape \(2, 2\)"),
    ({"kind": "area"}, "kind 'area' is none of point, spot, directional, rect, disk, sphere, triangle"),
    ({"kind": "rect", "width": 1.0}, "light 0: height is 0, must be above 0"),
    ({"kind": "disk", "width": 1.0, "height": [1.0, -2.0]}, "light 1: height is -2, must be above 0"),
    ({"kind": "sphere"}, "light 0: radius is 0, must be above 0"),
    ({"kind": "rect", "width": 1, "height": 1, "direction": (0, 0, 0)}, "direction of light 0 is zero or not finite"),
    ({"side": [[0, 1], [1, 0]]}, r"lights: side has the shape \(2, 2\)"),
    ({"kind": "spot", "direction": (0, 0, 0)}, "direction of light 0 is zero or not finite"),
    ({"kind": "spot", "inner_cone": 1.0, "outer_cone": 0.5}, "light 0: inner cone 1, outer cone 0.5: must be 0 <= inner < outer <= pi / 2"),
    ({"kind": "spot", "inner_cone": -0.5, "outer_cone": 0.5}, "light 0: inner cone -0.5, outer cone 0.5: must be 0 <= inner < outer <= pi / 2"),
    ({"kind": "spot", "outer_cone": 4.0}, "light 0: inner cone 0, outer cone 4: must be 0 <= inner < outer <= pi / 2"),
])
def test_bad_lights_are_refused_in_one_line(lights, words):
    with pytest.raises(kilolux.Error, match=words):
        made = kilolux.Lights(**{"position": [[0, 1, 0], [0, 2, 0]], **lights})
        kilolux.Renderer("grid", resolution=(64, 48), lights=made)


def test_three_values_for_three_lights_have_two_meanings():
    position = [[-1, 1, 0], [0, 1, 0], [1, 1, 0]]
    with pytest.raises(kilolux.Error, match=r"3 lights: \(3, 1\) is a value for each, \(1, 3\) a colour for all"):
        kilolux.Lights(position, [1, 2, 3])

    def picture(intensity):
        return kilolux.render("grid", resolution=(64, 48), lights=kilolux.Lights(position, intensity, 4.0)).radiance

    for said, meant in (([[1], [2], [3]], [[1] * 3, [2] * 3, [3] * 3]), ([[1, 2, 3]], [[1, 2, 3]] * 3)):
        np.testing.assert_array_equal(picture(said), picture(meant))


@pytest.mark.parametrize("other, words", [
    ({"range": [2.0, np.nan]}, "range of light 1 is nan; 1 of 2 lights are left out"),
    ({"range": [-1.0, 2.0]}, "range of light 0 is -1.0"),
    ({"range": [2.0, np.inf]}, "range of light 1 is inf"),
    ({"intensity": [[1, 1, 1], [1, -0.5, 1]]}, "intensity of light 1 is .*-0.5.*; 1 of 2 lights are left out"),
    ({"position": [[0, 1, 0], [0, np.inf, 0]]}, "position of light 1"),
])
def test_lights_that_cannot_be_are_left_out_with_a_warning(other, words):
    made = kilolux.Lights(**{"position": [[0, 1, 0], [0, 1, 0]], "range": 2.0, **other})
    with pytest.warns(UserWarning, match=words):
        frame = kilolux.render("grid", resolution=(64, 48), lights=made)
    assert frame.stats["lights"]["used"] == 1 and frame.stats["lights"]["rejected"] == 1
    alone = kilolux.render("grid", resolution=(64, 48), lights=kilolux.Lights([[0, 1, 0]], range=2.0))
    np.testing.assert_array_equal(frame.radiance, alone.radiance)


@pytest.mark.parametrize("kind, sizes", [
    ("rect", {"width": 0.5, "height": [0.25, 0.5]}),
    ("disk", {"width": 0.5, "height": 0.25, "side": (0, 0, 2), "two_sided": [True, False]}),
    ("sphere", {"radius": 0.125}),
    ("triangle", {"width": 0.5, "height": 0.25, "skew": -0.125}),
])
def test_lights_have_sizes(kind, sizes):
    lights = kilolux.Lights([[0, 1, 0], [1, 1, 0]], 5.0, 4.0, kind=kind, **sizes)
    frame = kilolux.render("grid", resolution=(64, 48), lights=lights)
    assert frame.stats["lights"]["used"] == 2
    assert "area-lights" in frame.stats["plan"]
