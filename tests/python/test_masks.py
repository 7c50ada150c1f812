# SPDX-License-Identifier: Apache-2.0
"""What other libraries mark as missing is NaN, and what attributes mean is applied."""
import warnings

import numpy
import pytest

import pellucid

SHAPE = (3, 4, 5)
VALUES = numpy.arange(60).reshape(SHAPE)
HIDDEN = VALUES < 7  # by value, not by place


def masked(kind="f4"):
    return numpy.ma.MaskedArray(VALUES.astype(kind), HIDDEN)


def assert_hides(data, hidden=HIDDEN, values=VALUES):
    """The values as they are, and NaN where they are hidden."""
    array = pellucid.Volume(data).array
    assert array.shape == SHAPE
    assert numpy.array_equal(numpy.isnan(array), hidden)
    assert numpy.array_equal(array[~hidden], numpy.asarray(values)[~hidden])


class Asked:
    """Gives what numpy asks for, as variables of netCDF4 and arrays of dask do."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


class Unmasked(numpy.ndarray):
    """As astropy's Masked: an array that is no numpy.ma, with a mask."""

    @property
    def unmasked(self):
        return self.view(numpy.ndarray)

    @property
    def mask(self):
        return HIDDEN


@pytest.mark.parametrize("kind", ["u1", "<i2", ">i2", "i4", "i8", "f2", ">f4", "f8", "?"])
def test_masks_that_come_out_of_array(kind):
    values = VALUES.astype(kind)
    assert_hides(Asked(numpy.ma.MaskedArray(values, HIDDEN)), values=values)


@pytest.mark.parametrize("data", [
    list(masked()), tuple(masked("i2")), [Asked(part) for part in masked()],
    [list(part) for part in masked("i4")],
    [VALUES[0].astype("f4"), *masked()[1:]],
])
def test_lists_of_masked_slices(data):
    hidden = HIDDEN.copy()
    if not isinstance(data[0], (list, Asked)) and not numpy.ma.isMaskedArray(data[0]):
        hidden[0] = False
    assert_hides(data, hidden)


def test_a_masked_number_in_a_list():
    data = VALUES.tolist()
    data[0][0][0] = numpy.ma.masked
    hidden = numpy.zeros(SHAPE, dtype=bool)
    hidden[0, 0, 0] = True
    assert_hides(data, hidden)


def test_masks_of_other_shapes_and_kinds():
    assert_hides(VALUES.astype("f4").view(Unmasked))
    assert_hides(masked()[numpy.newaxis])
    everything = numpy.ma.MaskedArray(VALUES.astype("f4"), True)
    assert numpy.isnan(pellucid.Volume(everything).array).all()
    hard = masked()
    hard.harden_mask()
    assert_hides(hard)
    infinite = masked()
    infinite.data[HIDDEN] = numpy.inf  # beneath the mask
    assert_hides(infinite)


@pytest.mark.parametrize("kind, words", [("c8", "complex"), ("O", "astype"), ("M8[s]", "times")])
def test_masked_arrays_of_other_types_are_refused(kind, words):
    values = VALUES.astype("i8").astype(kind)
    with pytest.raises(pellucid.Error, match=words):
        pellucid.Volume(numpy.ma.MaskedArray(values, HIDDEN))
    records = numpy.ma.MaskedArray(numpy.zeros(SHAPE, dtype=[("a", "f4")]), HIDDEN)
    with pytest.raises(pellucid.Error, match="one field"):
        pellucid.Volume(records)


def test_what_is_beneath_a_mask_is_not_told():
    values = VALUES.astype("i8")
    values[HIDDEN] = -2 ** 62
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert_hides(numpy.ma.MaskedArray(values, HIDDEN))


def test_positions_that_are_masked_are_refused():
    z = numpy.ma.MaskedArray([0.0, 1, 1e37], [False, False, True])
    with pytest.raises(pellucid.Error, match="finite"):
        pellucid.Volume(VALUES, coordinates=(z, None, None))
    whole = numpy.ma.MaskedArray([0.0, 1, 5])
    assert pellucid.Volume(VALUES, coordinates=(whole, None, None)).coordinates[0][2] == 5
    points = numpy.eye(4)[:, :3]
    hidden = numpy.zeros(points.shape, dtype=bool)
    hidden[3, 0] = True
    with pytest.raises(pellucid.Error):
        pellucid.Mesh(numpy.ma.MaskedArray(points, hidden), {"tetra": [[0, 1, 2, 3]]},
                      {"v": numpy.arange(4.0)})


def test_masks_of_meshes():
    values = Asked(numpy.ma.MaskedArray([0.0, 1, 2, 3], [True, False, False, False]))
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    mesh = pellucid.Mesh(points, {"tetra": [[0, 1, 2, 3]]}, {"v": values})
    assert mesh.statistics["vacuum"] == 1


def test_what_a_library_raises_is_one_line():
    class Closed:
        def __array__(self, dtype=None, copy=None):
            raise RuntimeError("NetCDF: Not a valid ID\nin line 3")

    with pytest.raises(pellucid.Error, match="Closed .NetCDF: Not a valid ID.") as error:
        pellucid.Volume(Closed(), name="data")
    assert "\n" not in str(error.value)
    with pytest.raises(pellucid.Error, match="expected an array, got <"):
        pellucid.Volume(object())


class WithAttributes(Asked):
    """As a dataset of h5py, or an array of zarr."""

    def __init__(self, array, **attributes):
        super().__init__(array)
        self.attrs = attributes


@pytest.mark.parametrize("kind, attributes, hidden, values", [
    ("i2", {"_FillValue": numpy.int16(7)}, VALUES == 7, VALUES),
    ("i2", {"_FillValue": [7], "missing_value": [8, 9]}, (VALUES >= 7) & (VALUES <= 9), VALUES),
    ("f4", {"missing_value": 7.0}, VALUES == 7, VALUES),
    ("i2", {"scale_factor": 0.5, "add_offset": 3.0}, VALUES < 0, VALUES * 0.5 + 3),
    ("i2", {"scale_factor": -0.5, "_FillValue": 7}, VALUES == 7, VALUES * -0.5),
    ("i2", {"valid_range": numpy.array([3, 50], "i2")}, (VALUES < 3) | (VALUES > 50), VALUES),
    ("f4", {"valid_min": 3.5}, VALUES < 3.5, VALUES),
    ("i2", {"valid_max": numpy.int16(50), "scale_factor": 2.0}, VALUES > 50, VALUES * 2.0),
    ("i2", {"valid_max": 20.5, "scale_factor": 0.5}, VALUES > 41, VALUES * 0.5),
    ("i2", {"valid_max": 4.1, "scale_factor": 0.1}, VALUES > 41, (VALUES * 0.1).astype("f4")),
    ("i2", {"valid_max": -20.0, "scale_factor": -0.5}, VALUES < 40, VALUES * -0.5),
    ("i1", {"_Unsigned": "true", "_FillValue": numpy.int8(-1)}, VALUES == 59,
     (VALUES + 196) % 256),
    ("u1", {"_Unsigned": "false", "_FillValue": numpy.uint8(255)}, VALUES == 59, VALUES - 60),
    ("u1", {"_Unsigned": "false", "valid_min": numpy.uint8(250)}, VALUES < 54, VALUES - 60),
])
def test_attributes_are_applied_and_told(kind, attributes, hidden, values):
    wraps = kind in ("i1", "u1")
    stored = (VALUES + 196).astype("u1").view(kind) if wraps else VALUES.astype(kind)
    with pytest.warns(pellucid.Note, match="its attributes say"):
        assert_hides(WithAttributes(stored, **attributes), hidden, values)


@pytest.mark.parametrize("attributes", [
    {}, {"units": "K", "long_name": "temperature"}, {"_FillValue": numpy.nan},
    {"_FillValue": 99}, {"_FillValue": 1e36}, {"valid_range": [0, 59]},
    {"scale_factor": 1.0, "add_offset": 0.0},
])
def test_attributes_that_change_nothing_are_not_told(attributes):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert_hides(WithAttributes(VALUES.astype("i2"), **attributes), VALUES < 0)


@pytest.mark.parametrize("attributes, told", [
    ({"scale_factor": "0.5"}, "its scale_factor is no number and is not applied"),
    ({"scale_factor": numpy.array([2.0, 3.0])}, "its scale_factor is no number"),
    ({"add_offset": numpy.nan}, "its add_offset is no number"),
    ({"_FillValue": "x"}, "its _FillValue is no number"),
    ({"missing_value": "none"}, "its missing_value is no number"),
    ({"valid_range": "0 to 5"}, "its valid_range is no pair of numbers"),
    ({"valid_range": numpy.array([5])}, "its valid_range is no pair of numbers"),
    ({"valid_min": [1, 2]}, "its valid_min is no number"),
    ({"slope": 2.0, "intercept": 1.0}, r"that are not applied \(slope, intercept\)"),
    ({"element_size_um": [2.0, 1, 1]}, r"not applied \(element_size_um\)"),
    ({"nodata": 7}, r"not applied \(nodata\)"),
    ({"SPACING": [3.0, 2, 1], "dz": 3.0}, r"not applied \(SPACING, dz\)"),
    ({"SCALE_FACTOR": 2.0}, r"not applied \(SCALE_FACTOR\)"),
    ({"flag_values": [1, 2]}, "its values are labels"),
])
def test_attributes_that_are_not_applied_are_told(tmp_path, attributes, told):
    with pytest.warns(pellucid.Note, match=told):
        assert_hides(WithAttributes(VALUES.astype("i2"), **attributes), VALUES < 0)
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        data = file.create_dataset("v", data=VALUES.astype("i2"))
        data.attrs.update(attributes)
        with pytest.warns(pellucid.Note, match=told):
            assert_hides(data, VALUES < 0)


def test_zarr_as_xarray_writes_it():
    data = WithAttributes(VALUES.astype("f4"))
    data.fill_value = 0.0
    assert_hides(data, VALUES < 0)  # any other store: 0 is a number
    data.attrs["_ARRAY_DIMENSIONS"] = ["z", "y", "x"]
    with pytest.warns(pellucid.Note, match="_FillValue"):
        assert_hides(data, VALUES == 0)


@pytest.mark.parametrize("kind, fill", [("f4", 9.969209968386869e36), ("i2", -32767),
                                        ("i4", -2147483647), ("u2", 65535)])
@pytest.mark.parametrize("attribute", ["fillvalue", "fill_value"])
def test_what_netcdf_never_wrote_is_missing(kind, fill, attribute):
    """As h5py gives a file of NetCDF, whose variable has no attribute for it."""
    values = VALUES.astype(kind)
    values[1, 2, 3] = fill
    data = WithAttributes(values)
    setattr(data, attribute, values.dtype.type(fill))
    with pytest.warns(pellucid.Note, match="_FillValue"):
        assert_hides(data, values == values[1, 2, 3], values)


def test_other_fill_values_are_told():
    data = WithAttributes(VALUES.astype("f4"))
    data.fillvalue = numpy.float32(7)
    with pytest.warns(pellucid.Note, match="its fill value, 7.0, are shown"):
        assert_hides(data, VALUES < 0)
    data.fillvalue = numpy.float32(-5)  # is nowhere
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert_hides(data, VALUES < 0)


def test_a_place_that_is_not_read_is_told():
    data = Asked(VALUES)
    data.affine = numpy.eye(4)
    with pytest.warns(pellucid.Note, match="the affine of a Asked is not read"):
        pellucid.Volume(data)


def test_dask():
    array = pytest.importorskip("dask.array")
    assert_hides(array.from_array(masked(), chunks=2))
    assert_hides([array.from_array(part, chunks=2) for part in masked("i2")])


def test_h5py(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        data = file.create_dataset("v", data=VALUES.astype(">i2"))
        assert_hides(data, VALUES < 0)
        data.attrs["_FillValue"] = numpy.int16(7)
        with pytest.warns(pellucid.Note, match="_FillValue"):
            assert_hides(data, VALUES == 7)
    with pytest.raises(pellucid.Error, match="expected an array"):
        pellucid.Volume(data)  # closed


def test_zarr():
    zarr = pytest.importorskip("zarr")
    data = zarr.array(VALUES.astype("f4"), fill_value=0)
    assert_hides(data, VALUES < 0)
    data.attrs["_ARRAY_DIMENSIONS"] = ["z", "y", "x"]
    with pytest.warns(pellucid.Note, match="_FillValue"):
        assert_hides(data, VALUES == 0)


def test_pandas():
    pandas = pytest.importorskip("pandas")
    frames = [pandas.DataFrame({str(x): pandas.array([None if v < 7 else v for v in plane[:, x]],
                                                     dtype="Int64") for x in range(5)})
              for plane in VALUES]
    assert_hides(frames)
    values = pandas.Series([None, 1, 2, 3], dtype="Int32")
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    mesh = pellucid.Mesh(points, {"tetra": [[0, 1, 2, 3]]}, {"v": values})
    assert mesh.statistics["vacuum"] == 1


def test_torch():
    torch = pytest.importorskip("torch")
    tensor = torch.arange(60.0).reshape(SHAPE)
    assert_hides(tensor, VALUES < 0)
    tensor.requires_grad_()
    with pytest.raises(pellucid.Error, match="grad"):
        pellucid.Volume(tensor)
