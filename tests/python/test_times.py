# SPDX-License-Identifier: Apache-2.0
"""Times of the steps of files, and values between them, against numpy."""

import json

import numpy as np
import pytest

import pellucid
from pellucid._notes import in_keywords, tell

SHAPE = (3, 4, 5)


@pytest.fixture
def steps(tmp_path):
    """Steps at the times 3, 1 and 2, in this order, with NaN in some places."""
    random = np.random.default_rng(7)
    values = random.random((3, *SHAPE)).astype(np.float32)
    values[0, 0, 0, 0] = values[2, 2, 3, 4] = np.nan
    np.savez(tmp_path / "a.npz", v=values, time=np.array([3.0, 1.0, 2.0]))
    return tmp_path / "a.npz", values


def test_times(steps, tmp_path):
    path, values = steps
    assert pellucid.times(path, array="v") == [1, 2, 3]
    np.save(tmp_path / "b.npy", values)
    assert pellucid.times(tmp_path / "b.npy", axes="tzyx") == [0, 1, 2]
    assert pellucid.times(tmp_path / "b.npy") == []
    assert pellucid.times("builtin:ramp:8") == []
    with pytest.raises(pellucid.Error, match="none.npy"):
        pellucid.times(tmp_path / "none.npy")


def test_each_step_by_its_time(steps):
    path, values = steps
    for index, time in enumerate((3, 1, 2)):
        read = pellucid.read_volume(path, array="v", time=time)
        assert np.array_equal(read.array, values[index], equal_nan=True)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.uint8, np.int16])
def test_linear_in_time(tmp_path, dtype):
    random = np.random.default_rng(3)
    values = (200 * random.random((3, *SHAPE))).astype(dtype)
    np.savez(tmp_path / "a.npz", v=values, time=np.array([3.0, 1.0, 2.0]))
    kept = np.float64 if dtype == np.float64 else np.float32
    for time, before, after, share in ((1.25, 1, 2, 0.25), (2.875, 2, 0, 0.875)):
        read = pellucid.read_volume(tmp_path / "a.npz", array="v", time=time,
                                    time_between="linear")
        mixed = ((1 - share) * values[before].astype(np.float64)
                 + share * values[after].astype(np.float64)).astype(kept)
        assert read.array.dtype == kept
        assert np.array_equal(read.array, mixed)
    for time, index in ((2, 2), (0, 1), (9, 0)):
        read = pellucid.read_volume(tmp_path / "a.npz", array="v", time=time,
                                    time_between="linear")
        assert read.array.dtype == dtype
        assert np.array_equal(read.array, values[index])


def test_a_scene_has_the_function_of_all_steps(tmp_path):
    values = np.zeros((3, *SHAPE), np.float32)
    for step, top in enumerate((1, 200, 4)):
        values[step] = np.linspace(0, top, values[step].size).reshape(SHAPE)
    np.savez(tmp_path / "a.npz", v=values, time=np.array([3.0, 1.0, 2.0]))
    field = {"file": "a.npz", "array": "v"}
    (tmp_path / "s.json").write_text(json.dumps({"layers": [{"field": field}], "time": 3}))
    layer = pellucid.load_scene(tmp_path / "s.json").layers[0]
    assert layer.data.array.max() == 1
    assert layer.transfer_function.points[-1][0] > 100
    (tmp_path / "s.json").write_text(json.dumps({"layers": [{"field": {**field, "time": 3}}]}))
    alone = pellucid.load_scene(tmp_path / "s.json").layers[0]
    assert alone.transfer_function.points[-1][0] < 2


def test_what_linear_needs(steps):
    path, values = steps
    read = pellucid.read_volume(path, array="v", time=2.5, time_between="linear")
    assert np.array_equal(np.isnan(read.array), np.isnan(values[0]) | np.isnan(values[2]))
    with pytest.raises(pellucid.Error, match="needs a time"):
        pellucid.read_volume(path, array="v", time_between="linear")
    with pytest.raises(pellucid.Error, match="nearest"):
        pellucid.read_volume(path, array="v", time=1, time_between="cubic")
    with pytest.raises(pellucid.Error, match="no finite number"):
        pellucid.read_volume(path, array="v", time=float("nan"))


def test_nibabel_writes_them(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    values = np.random.default_rng(1).random((5, 4, 3, 3)).astype(np.float32)
    image = nibabel.Nifti1Image(values, np.eye(4))
    image.header.set_xyzt_units("mm", "sec")
    image.header["pixdim"][4] = 2.5
    image.header["toffset"] = 10
    nibabel.save(image, tmp_path / "a.nii.gz")
    assert pellucid.times(tmp_path / "a.nii.gz") == [10, 12.5, 15]
    read = pellucid.read_volume(tmp_path / "a.nii.gz", time=12)
    assert np.array_equal(read.array, values[..., 1].T)


def test_notes_name_keywords():
    with pytest.warns(pellucid.Note, match=r"^a\.pvd: 5 times; time= chooses one$"):
        tell("a.pvd: 5 times; --time chooses one")
    assert in_keywords("read with (--centering point), (--level) or --array-axes zyx") == \
        'read with (centering="point"), (level=) or axes= zyx'
    assert in_keywords("a --time.npy --time-steps --precision") == \
        "a --time.npy --time-steps --precision"
