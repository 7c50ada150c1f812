# SPDX-License-Identifier: Apache-2.0
"""Arrays whose axes have names: xarray's, and variables of netCDF4."""
import warnings

import numpy
import pytest

import pellucid

SHAPE = (3, 4, 5)
VALUES = numpy.arange(60, dtype="f4").reshape(SHAPE)
Z, Y, X = numpy.array([1.0, 3, 7]), 10 - 2.0 * numpy.arange(4), 0.5 * numpy.arange(5)


@pytest.fixture
def xarray():
    return pytest.importorskip("xarray")


def silent(data):
    with warnings.catch_warnings():
        warnings.simplefilter("error", pellucid.Note)
        return pellucid.Volume(data)


@pytest.mark.parametrize("names", [("level", "y", "x"), ("depth", "lat", "lon"),
                                   ("plev", "latitude", "longitude"), ("band", "LAT", "LON")])
def test_maps_one_upon_the_other_need_no_note(xarray, names):
    data = xarray.DataArray(VALUES, dims=names, coords=dict(zip(names, (Z, Y, X))))
    volume = silent(data)
    assert numpy.array_equal(volume.array, VALUES)
    assert numpy.array_equal(volume.coordinates[0], Z) and volume.spacing[2] == 0.5
    assert volume.direction[1, 1] == -1 and volume.origin[1] == 10


@pytest.mark.parametrize("names", [("lon", "lat", "lev"), ("dim_0", "dim_1", "dim_2"),
                                   ("x", "lat", "lon"), ("z", "x", "lat")])
def test_axes_that_are_taken_by_place_are_told(xarray, names):
    data = xarray.DataArray(VALUES, dims=names)
    with pytest.warns(pellucid.Note, match=f"{', '.join(names)} are taken as z, y and x"):
        assert numpy.array_equal(pellucid.Volume(data).array, VALUES)


@pytest.mark.parametrize("name, coordinates, attributes", [
    ("time", None, {}),
    ("T", [0, 1, 2], {}),
    ("day", numpy.array(["2000-01-01", "2000-01-02", "2000-01-04"], "M8[ns]"), {}),
    ("lag", numpy.array([0, 1, 2], "m8[ns]"), {}),
    ("step", [0, 6, 12], {"units": "hours since 2000-01-01"}),
    ("step", [0, 6, 12], {"axis": "T"}),
    ("step", [0, 6, 12], {"standard_name": "time"}),
])
@pytest.mark.parametrize("place", [0, 2])
def test_time_is_no_axis_of_space(xarray, name, coordinates, attributes, place):
    names = ["lat", "lon"]
    names.insert(place, name)
    side = SHAPE[place]
    coords = {}
    if coordinates is not None:
        given = numpy.resize(coordinates, side) if side != 3 else coordinates
        coords[name] = (name, given, attributes)
    data = xarray.DataArray(VALUES, dims=names, coords=coords)
    with pytest.raises(pellucid.Error, match=f"\"{name}\" is time; choose one, as in data.isel"):
        pellucid.Volume(data)
    assert pellucid.Volume(data.values).shape == SHAPE


def test_one_time_of_several_axes_is_left_out(xarray):
    data = xarray.DataArray(VALUES[numpy.newaxis], dims=("time", "z", "y", "x"))
    assert silent(data).shape == SHAPE


def test_coordinates_that_are_no_numbers_are_refused(xarray):
    data = xarray.DataArray(VALUES, dims=("band", "y", "x"),
                            coords={"band": ["red", "green", "blue"]})
    with pytest.raises(pellucid.Error, match="no numbers; .*drop_vars"):
        pellucid.Volume(data)
    assert silent(data.drop_vars("band")).shape == SHAPE
    with pytest.raises(pellucid.Error, match="finite"):
        pellucid.Volume(xarray.DataArray(VALUES, dims=("z", "y", "x"),
                                         coords={"z": [0, numpy.nan, 2]}))


def test_coordinates_of_several_axes_are_told(xarray):
    wide = numpy.ones((4, 5))
    data = xarray.DataArray(VALUES, dims=("z", "y", "x"), coords={"lat": (("y", "x"), wide)})
    with pytest.warns(pellucid.Note, match="coordinates lat, which change along several axes"):
        pellucid.Volume(data)


def test_depths_that_go_down_are_told(xarray):
    depth = ("depth", Z, {"positive": "down"})
    data = xarray.DataArray(VALUES, dims=("depth", "lat", "lon"), coords={"depth": depth})
    with pytest.warns(pellucid.Note, match="\"depth\" is positive down"):
        assert pellucid.Volume(data).coordinates[0][2] == 7
    assert silent(data.assign_coords(depth=-Z)).direction[0, 0] == -1


def test_xarray_decodes_or_we_do(xarray):
    attributes = {"_FillValue": numpy.int16(7), "scale_factor": 0.5, "add_offset": 100.0}
    stored = xarray.DataArray(VALUES.astype("i2"), dims=("z", "y", "x"), attrs=attributes)
    with pytest.warns(pellucid.Note, match="_FillValue, scale_factor"):
        ours = pellucid.Volume(stored).array
    decoded = xarray.decode_cf(xarray.Dataset({"v": stored}))["v"]
    assert numpy.array_equal(silent(decoded).array, ours, equal_nan=True)
    assert numpy.isnan(ours[0, 1, 2]) and ours[0, 0, 1] == 100.5


def test_a_range_of_packed_values_holds_after_decoding(xarray):
    attributes = {"valid_range": numpy.array([5, 50], "i2"), "scale_factor": 0.1, "add_offset": 3.0}
    stored = xarray.DataArray(VALUES.astype("i2"), dims=("z", "y", "x"), attrs=attributes)
    decoded = xarray.decode_cf(xarray.Dataset({"v": stored}))["v"]
    for data in (stored, decoded):
        with pytest.warns(pellucid.Note, match="a valid range"):
            array = pellucid.Volume(data).array
        assert numpy.array_equal(numpy.isnan(array), (VALUES < 5) | (VALUES > 50))


def test_masks_within_xarray(xarray):
    array = pytest.importorskip("dask.array")
    masked = numpy.ma.masked_less(VALUES, 7)
    data = xarray.DataArray(array.from_array(masked, chunks=2), dims=("z", "y", "x"))
    assert numpy.array_equal(numpy.isnan(silent(data).array), VALUES < 7)


def net_cdf(path, names, coordinates, values=VALUES, **attributes):
    library = pytest.importorskip("netCDF4")
    file = library.Dataset(path, "w")
    for name, side in zip(names, values.shape):
        file.createDimension(name, side)
    for name, (kind, numbers, own) in coordinates.items():
        variable = file.createVariable(name, kind, (name,), fill_value=own.pop("_FillValue", None))
        variable.setncatts(own)
        variable[:] = numbers
    variable = file.createGroup("g").createVariable(
        "v", "i2", names, fill_value=attributes.pop("_FillValue", None))
    variable.setncatts(attributes)
    variable.set_auto_maskandscale(False)
    variable[:] = values
    file.close()
    return library.Dataset(path)["g/v"]


def test_netcdf4_has_place_and_mask(tmp_path):
    variable = net_cdf(tmp_path / "a.nc", ("lev", "lat", "lon"),
                       {"lev": ("f8", Z, {}), "lat": ("f4", Y, {"units": "degrees_north"})},
                       _FillValue=7, scale_factor=0.5)
    volume = silent(variable)
    assert volume.name == "v" and numpy.array_equal(volume.coordinates[0], Z)
    assert volume.direction[1, 1] == -1 and volume.spacing[1:] == (2, 1)
    assert numpy.array_equal(numpy.isnan(volume.array), VALUES == 7)
    assert volume.array[2, 3, 4] == 29.5


def test_netcdf4_of_times_and_places(tmp_path):
    hours = {"time": ("f8", [0.0], {"units": "hours since 2000-01-01"})}
    variable = net_cdf(tmp_path / "a.nc", ("time", "z", "y", "x"), hours, VALUES[numpy.newaxis])
    assert numpy.array_equal(silent(variable).array, VALUES)
    several = {"t0": ("f8", Z, {"units": "hours since 2000-01-01"})}
    with pytest.raises(pellucid.Error, match="\"t0\" is time"):
        pellucid.Volume(net_cdf(tmp_path / "b.nc", ("t0", "lat", "lon"), several))
    with pytest.warns(pellucid.Note, match="x, y, lev are taken as z, y and x"):
        pellucid.Volume(net_cdf(tmp_path / "c.nc", ("x", "y", "lev"), {}))


def test_missing_coordinates_are_refused(tmp_path):
    levels = {"lev": ("f8", numpy.ma.masked_equal(Z, 3), {"_FillValue": -1.0})}
    with pytest.raises(pellucid.Error, match="coordinates of its axis \"lev\" are missing"):
        pellucid.Volume(net_cdf(tmp_path / "a.nc", ("lev", "lat", "lon"), levels))
