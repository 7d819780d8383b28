"""Table as a mapping: of the standard library, of pandas, and with columns that must not be."""

import copy
import pickle
from collections.abc import Mapping, MutableMapping

import numpy as np
import pytest

import pbf_tools


@pytest.fixture
def table():
    return pbf_tools.Table({"time": [0.0, 0.5, 1.0], "speed": np.array([0.0, 4.9, 9.8]),
                            "name": ["a", "b", "c"]}, {"time": "s", "speed": "m/s"})


def test_a_table_is_a_mapping_of_its_columns(table):
    assert isinstance(table, MutableMapping) and isinstance(table, Mapping)
    assert list(table) == list(table.keys()) == ["time", "speed", "name"]
    assert "speed" in table and "velocity" not in table and table.get("velocity") is None
    assert all(table[name] is values for name, values in table.items())
    assert [len(v) for v in table.values()] == [3, 3, 3]
    assert {**table}.keys() == dict(table).keys() == table.keys()
    assert type(dict(table)) is dict and type(table.columns) is dict
    assert len(table) == 3 and len(pbf_tools.Table({})) == 0  # rows, as of a DataFrame
    assert repr(table) == "<Table of 3 rows: time (s), speed (m/s), name>"
    with pytest.raises(pbf_tools.UnknownName, match="no column velocity; there are time, speed, name"):
        table["velocity"]


def test_pandas_takes_a_table_as_it_takes_a_dict(table, minimal):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(table)
    assert list(frame.columns) == list(table) and len(frame) == 3
    assert frame["speed"].tolist() == table["speed"].tolist()
    log = pbf_tools.open(minimal).log
    frame = pandas.DataFrame(log)
    assert frame.shape == (26, len(list(log)))
    assert all(np.array_equal(frame[name], log[name]) for name in log)


def test_what_pandas_does_with_a_dict_gives_every_column(minimal):
    log = pbf_tools.open(minimal).log
    assert isinstance(log, dict)  # what pandas asks before it takes keys as names of columns
    arrays = {name: log[name] for name in log.keys()}
    assert {len(a) for a in arrays.values()} == {26} and all(a.ndim == 1 for a in arrays.values())


@pytest.mark.parametrize("add", [
    lambda t: t.__setitem__("way", [1.0, 2.0]), lambda t: t.update(way=[1.0]),
    lambda t: t.setdefault("way", []), lambda t: t.__ior__({"way": np.zeros((2, 3))}),
    lambda t: t.__setitem__("way", 3.0)])
def test_no_way_of_adding_a_column_makes_a_ragged_table(table, add):
    with pytest.raises(pbf_tools.BadInput, match="column way: .* one length, here 3"):
        add(table)
    assert "way" not in table and len(table) == 3


def test_columns_can_be_added_replaced_and_removed(table):
    table["way"] = table["speed"] * 0.5
    table |= {"place": np.zeros((3, 3))}
    del table["name"]
    assert list(table) == ["time", "speed", "way", "place"]
    assert list(table.flat())[-3:] == ["place_x", "place_y", "place_z"]
    with pytest.raises(pbf_tools.BadInput, match="one length"):
        pbf_tools.Table({"a": [1], "b": [1, 2]})


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, pbf_tools.Table.copy,
                                   lambda t: pickle.loads(pickle.dumps(t))])
def test_a_copy_is_a_table_with_the_same_units(table, again):
    other = again(table)
    assert type(other) is pbf_tools.Table and other.units == table.units
    assert other.csv() == table.csv()


def test_the_plan_has_a_name_of_its_own(minimal):
    run = pbf_tools.open(minimal)
    assert "plan" not in run.info and "passes of one update" in run.plan
    assert max(str(v).count("\n") for k, v in run.info.items() if "scene" not in k) == 0
