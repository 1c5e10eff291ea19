"""Scenes of arrays and of files."""

import numpy as np
import pytest
from conftest import box, quad

import photile


def test_areas_and_normals_of_a_box():
    scene = photile.Scene(box(5, 4, 2.5), lights=[photile.Light("lamp", 1)])
    assert scene.triangle_areas.sum() == pytest.approx(2 * (5 * 4 + 5 * 2.5 + 4 * 2.5))
    # Fronts look inwards: towards the middle.
    middles = scene.vertices[scene.triangles].mean(axis=1)
    inwards = np.einsum("tc,tc->t", scene.triangle_normals, np.array([2.5, 2, 1.25]) - middles)
    assert np.all(inwards > 0)


def test_arrays_are_views_that_cannot_be_written():
    scene = photile.Scene(box(1, 1, 1), lights=[photile.Light("lamp", 1)])
    assert np.shares_memory(scene.vertices, scene.vertices)
    assert np.shares_memory(scene.triangles, scene.triangles)
    with pytest.raises(ValueError):
        scene.vertices[0] = 0
    vertices = scene.vertices
    del scene
    assert np.isfinite(vertices).all()  # the view keeps the scene


def test_indexed_triangles_are_those_of_corners():
    corners = box(5, 4, 2.5)
    vertices, rows = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    lamp = photile.Light("lamp", 1)
    one = photile.Scene(corners, lights=[lamp])
    other = photile.Scene(rows.reshape(-1, 3), vertices, lights=[lamp])
    assert np.array_equal(one.vertices[one.triangles], other.vertices[other.triangles])


def test_what_was_given_is_what_there_is():
    triangles = np.concatenate([quad([0, 0, 0], [1, 0, 0], [0, 1, 0]),
                                quad([0, 0, 1], [0, 1, 0], [1, 0, 0])])
    glass = photile.Material("glass", interaction="glass", index_of_refraction=1.3, thin=True)
    scene = photile.Scene(
        triangles,
        materials=[photile.Material("red", (0.5, 0.1, 0.1)), glass],
        triangle_materials=[0, 1, 0, 0],
        lights=[photile.Light("spot", 50, "spot", position=(1, 2, 3), outer_angle=30, group="all"),
                photile.Light("panel", 100, "area", triangles=[2, 3], group="all"),
                photile.Light("sun", kind="directional", illuminance=1000, direction=(0, 0, -1))],
        cameras=[photile.Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), 35, "top", 1.5)],
    )
    assert scene.triangle_material.tolist() == [0, 1, 0, 0]
    assert scene.triangle_light.tolist() == [photile.NONE, photile.NONE, 1, 1]
    assert [light.triangles for light in scene.lights] == [[], [2, 3], []]
    spot = scene.lights[0]
    assert (spot.kind, spot.power, spot.position) == ("spot", 50, (1, 2, 3))
    assert spot.outer_angle == pytest.approx(30)
    found = scene.materials[1]
    assert (found.interaction, found.thin) == ("glass", True)
    assert found.index_of_refraction == pytest.approx(1.3)
    assert list(scene.layers) == ["all", "sun"] and scene.layers["all"] == 150
    camera = scene.cameras[0]
    assert camera.name == "top" and camera.aspect_ratio == 1.5
    assert camera.field_of_view == pytest.approx(35)
    assert np.allclose(np.subtract(camera.target, camera.position), (0, 0, -1))


def test_a_scene_of_arrays_far_from_the_origin_is_the_same_scene_there():
    far = np.array([560_000.25, 5_600_000.125, 3.0])  # floats lie half a metre apart there
    eye, aim = np.array([1.0, 1.0, 1.2]), np.array([4.0, 3.0, 1.0])

    def scene(offset):
        return photile.Scene(
            box(5, 4, 2.5) + offset,
            lights=[photile.Light("lamp", 1000, position=tuple(np.array([2.0, 1.5, 2.0]) + offset))],
            cameras=[photile.Camera(tuple(eye + offset), tuple(aim + offset), (0, 0, 1))],
        )

    near, there = scene(0 * far), scene(far)
    assert np.any(there.origin)
    corners = there.vertices[there.triangles].astype(float) + there.origin
    assert np.allclose(corners - far, near.vertices[near.triangles], atol=1e-6)
    assert np.allclose(there.lights[0].position, np.array([2.0, 1.5, 2.0]) + far, atol=1e-6, rtol=0)
    assert np.allclose(there.cameras[0].position, eye + far, atol=1e-6, rtol=0)
    photons = photile.trace(there, 10_000)
    assert np.all(photons.position + there.origin > far - 1e-3)
    assert np.all(photons.position + there.origin < far + [5.001, 4.001, 2.501])
    # Lux below the lamp: I / d^2, and what the walls reflect alike in both.
    points = np.array([[2.0, 1.5, 0.5], [1.0, 1.0, 0.5]])
    lux = [photile.measure(one, points + one_offset, (0, 0, 1), integrator="path", rays=64).lux
           for one, one_offset in ((near, 0 * far), (there, far))]
    assert np.allclose(*lux, rtol=0.05)


def test_a_texture_is_what_photons_see():
    # Half of the floor is black: photons of the lamp above it are absorbed there.
    texels = np.zeros((1, 2, 3), np.uint8)
    texels[0, 1] = 255
    scene = photile.Scene(quad([0, 0, 0], [2, 0, 0], [0, 2, 0]),
                          uv=[[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]],
                          materials=[photile.Material("half", (1, 1, 1), texture=texels)],
                          lights=[photile.Light("lamp", 1, position=(1, 1, 0.5))])
    photons = photile.trace(scene, 20_000)
    reached = 1 - photons.escaped_flux[0] - photons.absorbed_flux[0]
    assert abs(reached) < 1e-6
    direct = np.sum(photons.flux @ [0.2126, 0.7152, 0.0722])
    # White texels send all of it back into the open, black ones keep it; bilinear between them,
    # and symmetric, so that half is absorbed.
    assert photons.absorbed_flux[0] == pytest.approx(direct / 2, rel=0.03)


def test_a_file(tmp_path):
    (tmp_path / "floor.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl lamp\nmtllib floor.mtl\nusemtl lamp\nf 1 2 3\n"
    )
    (tmp_path / "floor.mtl").write_text("newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n")
    scene = photile.load(tmp_path / "floor.obj")
    assert scene.unit == "watt" and len(scene.triangles) == 1
    assert scene.layers["lamp"] == pytest.approx(np.pi * 0.5)  # pi x radiance x area


def test_the_sky_and_a_temperature_of_a_file(tmp_path):
    (tmp_path / "floor.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 0 0 1\nv 1 0 0\nusemtl m\nf 1 2 3\n")
    (tmp_path / "a.mtl").write_text("newmtl m\nKd 0.5 0.5 0.5\n")
    scene = photile.load(tmp_path / "floor.obj", sky=("uniform", 5000), sun=(180, 45, 20000))
    assert {light.kind for light in scene.lights} == {"environment", "directional"}
