"""Particles on obstacles and walls, against distances from the surfaces computed here."""

import numpy as np
import pytest

from pbf_tools import solids
from pbf_tools.errors import BadInput

LOW, HIGH = np.zeros(3), np.array([2.0, 1.0, 1.0])
D = 0.02


def box(x, plate):
    """Depth below the surface, m."""
    low, high = np.array(plate["min"], float), np.array(plate["max"], float)
    return np.minimum(x - low, high - x).min(axis=1)


def ball(x, o):
    return float(o["radius"]) - np.linalg.norm(x - np.array(o["center"], float), axis=1)


def segment(x, o):
    """Distance from the axis, and the way beyond its ends."""
    a, b = np.array(o["from"], float), np.array(o["to"], float)
    t = (x - a) @ (b - a) / ((b - a) @ (b - a))
    foot = a + np.clip(t, 0, 1)[:, None] * (b - a)
    length = np.linalg.norm(b - a)
    return np.linalg.norm(x - foot, axis=1), np.minimum(t, 1 - t) * length


def can(x, o):
    away, inside = segment(x, o)
    return np.minimum(float(o["radius"]) - away, inside)


def capsule(x, o):
    return float(o["radius"]) - segment(x, o)[0]


def plane(x, o):
    normal = np.array(o["normal"], float)
    return (np.array(o["point"], float) - x) @ normal / np.linalg.norm(normal)


SHAPES = [
    (box, {"shape": "box", "min": ["0.5", "0.2", "0.3"], "max": ["0.93", "0.6", "0.5"]}),
    (box, {"shape": "box", "min": ["0.5", "0.2", "0.3"], "max": ["0.9", "0.6", "0.34"]}),
    (ball, {"shape": "sphere", "center": ["1", "0.5", "0.5"], "radius": "0.3"}),
    (can, {"shape": "cylinder", "from": ["0.5", "0.5", "0.2"], "to": ["1.2", "0.6", "0.7"],
           "radius": "0.15"}),
    (capsule, {"shape": "capsule", "from": ["0.5", "0.5", "0.4"], "to": ["1.2", "0.6", "0.7"],
               "radius": "0.15"}),
    (plane, {"shape": "plane", "point": ["1", "0.5", "0.5"], "normal": ["0.3", "0.1", "1"]})]


def nearest(a, b):
    """Of every point of a the distance to the nearest of b."""
    return np.array([np.linalg.norm(b - x, axis=1).min() for x in a])


@pytest.mark.parametrize("depth, obstacle", SHAPES, ids=lambda v: v["shape"] if isinstance(v, dict) else "")
def test_particles_are_one_layer_half_a_spacing_deep_without_holes(depth, obstacle):
    points = solids.solid_of({"name": "o", **obstacle}, D, False, LOW, HIGH).points
    below = depth(points, obstacle)
    assert np.all(below > 0.4 * D) and np.all(below < 0.6 * D)
    # Every point of the surface, found by rejection, has a particle nearby.
    x = np.random.default_rng(2).uniform(LOW, HIGH, (400000, 3))
    near = x[np.abs(depth(x, obstacle)) < 0.1 * D][:2000]
    assert len(near) > 200 and nearest(near, points).max() < 1.25 * D
    # And they do not crowd.
    apart = [np.sort(np.linalg.norm(points - p, axis=1))[1] for p in points[::7]]
    assert np.median(apart) > 0.75 * D and min(apart) > 0.4 * D


@pytest.mark.parametrize("obstacle, depth", [
    ({"shape": "box", "min": ["0.5", "0", "0.3"], "max": ["0.9", "0.02", "0.34"]}, None),
    ({"shape": "sphere", "center": ["1", "0.01", "0.5"], "radius": "0.3"}, 0.3),
    ({"shape": "cylinder", "from": ["1", "0", "0.5"], "to": ["1", "0.02", "0.5"], "radius": "0.3"}, 0.3)])
def test_in_two_dimensions_particles_lie_in_the_plane(obstacle, depth):
    high = np.array([2, 0.02, 1])
    points = solids.solid_of({"name": "o", **obstacle}, D, True, LOW, high).points
    assert np.allclose(points[:, 1], 0.01)
    if depth:
        r = np.linalg.norm(points[:, ::2] - [1, 0.5], axis=1)
        assert np.allclose(r, depth - D / 2) and len(r) == pytest.approx(2 * np.pi * (depth - D / 2) / D, rel=0.03)
    else:
        assert len(points) == 40 and set(np.round(points[:, 2], 9)) == {0.31, 0.33}


def test_a_capsule_in_the_plane_is_its_outline():
    o = {"shape": "capsule", "from": ["0.5", "0.01", "0.4"], "to": ["1.2", "0.01", "0.7"], "radius": "0.1"}
    points = solids.solid_of({"name": "o", **o}, D, True, LOW, np.array([2, 0.02, 1])).points
    assert np.allclose(points[:, 1], 0.01) and np.allclose(capsule(points, o), D / 2)
    length = 2 * np.hypot(0.7, 0.3) + 2 * np.pi * (0.1 - D / 2)
    assert len(points) == pytest.approx(length / D, rel=0.05)


def test_a_box_is_turned_by_the_right_hand_rule_about_its_middle():
    keys = {"name": "o", "shape": "box", "min": ["0.5", "0.2", "0.3"], "max": ["0.9", "0.6", "0.34"],
            "turn_axis": ["0", "2", "0"], "turn_angle": "90"}
    points = solids.solid_of(keys, D, False, LOW, HIGH).points
    # x turns to -z: the plate stands.
    assert np.ptp(points[:, 0]) == pytest.approx(0.02) and np.ptp(points[:, 2]) == pytest.approx(0.38)
    assert np.allclose(points.mean(axis=0), [0.7, 0.4, 0.32])
    tilted = solids.solid_of({**keys, "turn_angle": "30"}, D, False, LOW, HIGH).points
    high = tilted[tilted[:, 2].argmax()]
    assert high[0] < 0.7  # the end at low x has gone up


def test_particles_outside_the_domain_are_left_out_but_of_what_moves():
    keys = {"name": "o", "shape": "sphere", "center": ["0", "0.5", "0.5"], "radius": "0.3"}
    rest = solids.solid_of(keys, D, False, LOW, HIGH)
    moving = solids.solid_of({**keys, "motion": {"kind": "sine"}}, D, False, LOW, HIGH)
    assert rest.points[:, 0].min() >= 0 and 0.4 < len(rest.points) / len(moving.points) < 0.6
    assert moving.moves and not rest.moves
    floating = solids.solid_of({**keys, "free": {"density": "500"}}, D, False, LOW, HIGH)
    assert floating.moves and np.array_equal(floating.points, moving.points)
    turn = solids.turn_about(np.array([0, 0, 1]), 90)
    assert np.allclose(moving.at(turn, np.array([1, 0.5, 0.5]))[:, 1], 0.5 + moving.points[:, 0])


@pytest.mark.parametrize("keys, text", [
    ({"shape": "mesh", "path": "a.stl"}, "obstacle o is a mesh"),
    ({"shape": "plane", "point": ["0", "0", "0"], "normal": ["0", "0", "1"], "motion": {}},
     "a plane that moves")])
def test_shapes_without_particles_are_named_with_the_remedy(keys, text):
    with pytest.raises(BadInput, match=f"{text}.*--no-solids"):
        solids.solid_of({"name": "o", **keys}, D, False, LOW, HIGH)


def test_walls_are_one_layer_around_the_domain_but_at_open_and_periodic_faces():
    high = np.array([0.2, 0.1, 0.06])
    everywhere = np.ones((3, 2), bool)
    points = solids.walls(LOW, high, D, everywhere, False)
    assert len(points) == 12 * 7 * 5 - 10 * 5 * 3 == len(np.unique(points.round(9), axis=0))
    outside = np.maximum(LOW - points, points - high).max(axis=1)
    assert np.allclose(outside, D / 2)
    some = everywhere.copy()
    some[0] = False  # periodic, or both faces open
    some[2, 1] = False
    points = solids.walls(LOW, high, D, some, False)
    assert len(points) == 10 * (7 * 4 - 5 * 3)
    assert points[:, 0].min() > 0 and points[:, 2].max() < 0.06
    flat = solids.walls(LOW, high, D, everywhere, True)
    assert len(flat) == 12 * 5 - 10 * 3 and np.allclose(flat[:, 1], 0.05)
    assert len(solids.walls(LOW, high, D, np.zeros((3, 2), bool), False)) == 0


@pytest.mark.parametrize("radius", [0.002, 0.01, 0.02])
def test_bodies_of_the_size_of_a_particle_have_at_least_one(radius):
    for keys in ({"shape": "sphere", "center": ["1", "0.5", "0.5"]},
                 {"shape": "cylinder", "from": ["1", "0.5", "0.5"], "to": ["1", "0.5", "0.505"]},
                 {"shape": "capsule", "from": ["1", "0.5", "0.5"], "to": ["1", "0.5", "0.505"]}):
        points = solids.solid_of({"name": "o", "radius": str(radius), **keys}, D, False, LOW, HIGH).points
        assert len(points) >= 1 and np.isfinite(points).all()
        assert np.linalg.norm(points - [1, 0.5, 0.5], axis=1).max() <= radius + 0.005
