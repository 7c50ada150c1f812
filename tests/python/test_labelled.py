# SPDX-License-Identifier: Apache-2.0
"""Arrays whose axes have names: of xarray, netCDF4, h5py and zarr."""
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


@pytest.mark.parametrize("names", [("level", "y", "x"), ("height", "lat", "lon"),
                                   ("plev", "latitude", "longitude"), ("bottom_top", "LAT", "LON")])
def test_maps_one_upon_the_other_need_no_note(xarray, names):
    data = xarray.DataArray(VALUES, dims=names, coords=dict(zip(names, (Z, Y, X))))
    volume = silent(data)
    assert numpy.array_equal(volume.array, VALUES)
    assert numpy.array_equal(volume.coordinates[0], Z) and volume.spacing[2] == 0.5
    assert volume.direction[1, 1] == -1 and volume.origin[1] == 10


def test_axes_that_are_taken_by_place_are_told(xarray):
    data = xarray.DataArray(VALUES, dims=("dim_0", "dim_1", "dim_2"))
    with pytest.warns(pellucid.Note, match="dim_0, dim_1, dim_2 are taken as z, y and x"):
        assert numpy.array_equal(pellucid.Volume(data).array, VALUES)
    data = xarray.DataArray(VALUES, dims=("p", "lat", "lon"))
    with pytest.warns(pellucid.Note, match="its axis p is taken for z; nothing says"):
        assert numpy.array_equal(pellucid.Volume(data).array, VALUES)
    data = xarray.DataArray(VALUES, dims=("band", "y", "x"))
    with pytest.warns(pellucid.Note, match="its axis band is taken for z"):
        assert numpy.array_equal(pellucid.Volume(data).array, VALUES)


@pytest.mark.parametrize("names, order", [(("lon", "lat", "lev"), (2, 1, 0)),
                                          (("z", "x", "lat"), (0, 2, 1)),
                                          (("rlat", "rlon", "height"), (2, 0, 1))])
def test_axes_are_turned_by_their_names(xarray, names, order):
    data = xarray.DataArray(VALUES, dims=names)
    assert numpy.array_equal(silent(data).array, VALUES.transpose(order))


@pytest.mark.parametrize("name, attributes, meaning", [
    ("number", {}, "members of an ensemble"), ("realization", {}, "members of an ensemble"),
    ("n", {"standard_name": "realization"}, "members of an ensemble"),
    ("n", {"axis": "E"}, "members of an ensemble"),
    ("step", {"units": "hours since 2000-01-01"}, "time"),
])
def test_members_are_no_axis_of_space(xarray, name, attributes, meaning):
    coords = {name: (name, [1.0, 2, 3], attributes)} if attributes else {}
    data = xarray.DataArray(VALUES, dims=(name, "lat", "lon"), coords=coords)
    with pytest.raises(pellucid.Error, match=f"\"{name}\" is {meaning}.*; choose one, as"):
        pellucid.Volume(data)
    several = xarray.DataArray(numpy.stack([VALUES] * 2, 1), dims=("z", name, "y", "x"))
    if not attributes:
        with pytest.raises(pellucid.Error, match=f"\"{name}\" is {meaning}"):
            pellucid.Volume(several)
    assert numpy.array_equal(silent(several.isel({name: 1})).array, VALUES)
    assert numpy.array_equal(silent(several.isel({name: [1]})).array, VALUES)


def test_channels_and_others_beside_places_are_refused(xarray):
    for name, meaning in (("band", "channels"), ("w", "none of x, y and z"), ("nv", "bounds")):
        data = xarray.DataArray(numpy.stack([VALUES] * 2), dims=(name, "z", "y", "x"))
        with pytest.raises(pellucid.Error, match=meaning):
            pellucid.Volume(data)
    with pytest.raises(pellucid.Error, match="has 2 axes; give three"):
        pellucid.Volume(xarray.DataArray(VALUES[0], dims=("y", "x")))
    with pytest.raises(pellucid.Error, match="time and not z: images, no volume"):
        pellucid.Volume(xarray.DataArray(VALUES[:1], dims=("time", "y", "x")))


def with_units(xarray, *units):
    coords = {axis: (axis, positions, {} if unit is None else {"units": unit})
              for axis, positions, unit in zip("zyx", (Z, Y, X), units)}
    return xarray.DataArray(VALUES, dims=("z", "y", "x"), coords=coords)


@pytest.mark.parametrize("units, factor", [
    (("mm", "um", "um"), 1e3), (("nm", "micrometer", "µm"), 1e-3), (("km", "m", "metres"), 1e3),
    (("mm", "um", None), 1e3)])
def test_lengths_of_several_units_become_one(xarray, units, factor):
    with pytest.warns(pellucid.Note, match="several units; lengths are turned into"):
        volume = pellucid.Volume(with_units(xarray, *units))
    assert numpy.allclose(volume.coordinates[0], Z * factor)
    assert volume.spacing[1:] == (2, 0.5)


@pytest.mark.parametrize("longitudes, origin", [((320.0, 340, 0, 20, 40), 320),
                                                ((140, 160, 180, -160, -140), 140),
                                                ((-160, -180, 160, 140, 120), -160)])
def test_longitudes_go_on_where_they_jump(xarray, longitudes, origin):
    lon = ("lon", numpy.array(longitudes), {"units": "degrees_east"})
    data = xarray.DataArray(VALUES, dims=("level", "lat", "lon"), coords={"lon": lon})
    with pytest.warns(pellucid.Note, match="longitudes go on where they jump by 360"):
        volume = pellucid.Volume(data)
    assert volume.spacing[2] == 20 and volume.origin[2] == origin
    twice = data.assign_coords(lon=("lon", [300.0, 0, 300, 0, 60], {"units": "degrees_east"}))
    with pytest.raises(pellucid.Error):
        pellucid.Volume(twice)


def test_units_that_are_no_lengths_are_told(xarray):
    assert numpy.array_equal(silent(with_units(xarray, "mm", "mm", "mm")).coordinates[0], Z)
    silent(with_units(xarray, None, "degrees_north", "degrees_east"))
    with pytest.warns(pellucid.Note, match="differ and are not all known lengths"):
        volume = pellucid.Volume(with_units(xarray, "hPa", "m", "m"))
    assert numpy.array_equal(volume.coordinates[0], Z)


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


def test_one_time_beside_bands_is_left_out(xarray):
    data = xarray.DataArray(VALUES[:, numpy.newaxis], dims=("band", "time", "y", "x"))
    with pytest.warns(pellucid.Note, match="its axis band is taken for z"):
        assert numpy.array_equal(pellucid.Volume(data).array, VALUES)


def test_one_time_of_several_axes_is_left_out(xarray):
    data = xarray.DataArray(VALUES[numpy.newaxis], dims=("time", "z", "y", "x"))
    assert silent(data).shape == SHAPE


def test_coordinates_that_are_no_numbers_are_refused(xarray):
    data = xarray.DataArray(VALUES, dims=("band", "y", "x"),
                            coords={"band": ["red", "green", "blue"]})
    with pytest.warns(pellucid.Note), pytest.raises(pellucid.Error, match="no numbers; .*drop_v"):
        pellucid.Volume(data)
    with pytest.warns(pellucid.Note, match="its axis band is taken for z"):
        assert pellucid.Volume(data.drop_vars("band")).shape == SHAPE
    with pytest.raises(pellucid.Error, match="finite"):
        pellucid.Volume(xarray.DataArray(VALUES, dims=("z", "y", "x"),
                                         coords={"z": [0, numpy.nan, 2]}))


def test_coordinates_of_several_axes_are_told(xarray):
    wide = numpy.ones((4, 5))
    data = xarray.DataArray(VALUES, dims=("z", "y", "x"), coords={"lat": (("y", "x"), wide)})
    with pytest.warns(pellucid.Note, match="coordinates lat, which change along several axes"):
        pellucid.Volume(data)


def test_depths_go_down(xarray):
    for kind in ("f8", "f4", "i4", "u2"):
        depth = ("depth", Z.astype(kind), {"positive": "down"})
        data = xarray.DataArray(VALUES, dims=("depth", "lat", "lon"), coords={"depth": depth})
        with pytest.warns(pellucid.Note, match=r"z is minus depth \(positive: down\)"):
            volume = pellucid.Volume(data)
        assert volume.direction[0, 0] == -1 and volume.coordinates[0][2] == 7
    with pytest.warns(pellucid.Note, match="z is depth, which grows downwards"):
        assert pellucid.Volume(data.assign_coords(depth=Z)).direction[0, 0] == 1


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
    assert numpy.array_equal(
        silent(net_cdf(tmp_path / "c.nc", ("x", "y", "lev"), {})).array, VALUES.T)
    members = {"e": ("f8", Z, {"standard_name": "realization"})}
    with pytest.raises(pellucid.Error, match="\"e\" is members of an ensemble"):
        pellucid.Volume(net_cdf(tmp_path / "d.nc", ("e", "lat", "lon"), members))


def test_netcdf4_has_units(tmp_path):
    variable = net_cdf(tmp_path / "a.nc", ("z", "y", "x"),
                       {"z": ("f4", Z, {"units": "mm"}), "y": ("f8", Y, {"units": "um"}),
                        "x": ("f8", X, {"units": "µm"})})
    with pytest.warns(pellucid.Note, match="lengths are turned into µm"):
        assert numpy.allclose(pellucid.Volume(variable).coordinates[0], Z * 1000)


def test_missing_coordinates_are_refused(tmp_path):
    levels = {"lev": ("f8", numpy.ma.masked_equal(Z, 3), {"_FillValue": -1.0})}
    with pytest.raises(pellucid.Error, match="coordinates of its axis \"lev\" are missing"):
        pellucid.Volume(net_cdf(tmp_path / "a.nc", ("lev", "lat", "lon"), levels))


def notes_of(data):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", pellucid.Note)
        volume = pellucid.Volume(data)
    return volume, "\n".join(str(each.message) for each in told)


def test_coordinates_of_other_names(xarray):
    # The one along an axis that has none of its own name, as in files.
    data = xarray.DataArray(VALUES, dims=("z", "y", "x"),
                            coords={"depth": ("z", Z), "lat": ("y", Y), "when": 3.0})
    volume = silent(data)
    assert numpy.array_equal(volume.coordinates[0], Z) and volume.spacing[1] == 2
    # Beside one of its own name, several of them, and words.
    both = xarray.DataArray(VALUES, dims=("z", "y", "x"), coords={"z": Z, "pressure": ("z", Z)})
    volume, notes = notes_of(both)
    assert numpy.array_equal(volume.coordinates[0], Z) and "pressure along z are left out" in notes
    several = xarray.DataArray(VALUES, dims=("z", "y", "x"),
                               coords={"p": ("z", Z), "q": ("z", Z), "s": ("y", list("abcd"))})
    volume, notes = notes_of(several)
    assert volume.coordinates[0] is None and "p, q are all along z" in notes
    wide = xarray.DataArray(VALUES, dims=("z", "y", "x"),
                            coords={"lat": (("y", "x"), VALUES[0]), "lon": (("y", "x"), VALUES[1])})
    assert "lat, lon, which change along several axes, are left out" in notes_of(wide)[1]


def test_netcdf4_coordinates_of_other_names(tmp_path):
    library = pytest.importorskip("netCDF4")
    with library.Dataset(tmp_path / "a.nc", "w") as file:
        for name, side in zip("zyx", SHAPE):
            file.createDimension(name, side)
        file.createVariable("depth", "f8", ("z",))[:] = Z
        file.createVariable("lat", "f8", ("y", "x"))[:] = VALUES[0]
        variable = file.createVariable("v", "f4", ("z", "y", "x"))
        variable[:] = VALUES
        variable.coordinates = "depth lat missing"
        volume, notes = notes_of(variable)
        assert numpy.array_equal(volume.coordinates[0], Z)
        assert "lat, which change along several axes" in notes


@pytest.mark.parametrize("masks, scales", [(False, True), (True, False), (False, False)])
def test_netcdf4_without_automatic_masks(tmp_path, masks, scales):
    variable = net_cdf(tmp_path / "a.nc", ("lev", "lat", "lon"),
                       {"lev": ("i2", [1, 3, 7], {"scale_factor": 0.5})}, _FillValue=7,
                       scale_factor=0.5, valid_max=numpy.int16(50))
    variable.set_auto_mask(masks)
    variable.set_auto_scale(scales)
    variable.group().parent["lev"].set_auto_maskandscale(False)
    volume, notes = notes_of(variable)
    hidden = (VALUES == 7) | (VALUES > 50)
    assert numpy.array_equal(numpy.isnan(volume.array), hidden)
    assert numpy.array_equal(volume.array[~hidden], 0.5 * VALUES[~hidden])
    assert numpy.array_equal(volume.coordinates[0], Z)
    assert "masked and scaled as its attributes say" in notes
    assert (variable.mask, variable.scale) == (masks, scales)


@pytest.fixture
def hdf5(tmp_path):
    with pytest.importorskip("h5py").File(tmp_path / "a.h5", "w") as file:
        yield file


def test_h5py_labels_and_scales(hdf5):
    data = hdf5.create_dataset("g/v", data=VALUES.transpose(2, 0, 1))
    data.dims[0].label, data.dims[1].label, data.dims[2].label = "x", "z", "y"
    assert numpy.array_equal(silent(data).array, VALUES)
    packed = hdf5.create_dataset("g/level", data=numpy.array([1, 3, 7], "i2"))
    packed.attrs["scale_factor"] = 0.5
    packed.attrs["positive"] = "down"
    packed.make_scale("level")
    scaled = hdf5.create_dataset("g/w", data=VALUES)
    scaled.dims[0].attach_scale(packed)
    volume, notes = notes_of(scaled)
    assert numpy.array_equal(volume.coordinates[0], 0.5 * Z) and volume.direction[0, 0] == -1
    assert "z is minus level" in notes
    data.dims[1].label = "time"
    with pytest.raises(pellucid.Error, match="\"time\" is time"):
        pellucid.Volume(data)
    data = hdf5.create_dataset("tagged", data=VALUES.T)
    data.attrs["axistags"] = '{"axes": [{"key": "x"}, {"key": "y"}, {"key": "z"}]}'
    assert numpy.array_equal(silent(data).array, VALUES)


def test_h5py_tells_what_stands_beside(hdf5):
    data = hdf5.create_dataset("g/v", data=VALUES)
    assert silent(data).spacing == (1, 1, 1)
    hdf5["spacing"], hdf5["g/x"], hdf5["g/affine"] = [1, 2, 3], numpy.arange(5), numpy.eye(4)
    hdf5["g/seed"], hdf5["g/other"] = 5, VALUES
    assert "beside it stand affine, x, spacing, which are not read" in notes_of(data)[1]
    data.attrs["axes"] = "xyz"
    assert "not applied (axes)" in notes_of(data)[1]


def test_zarr_has_names_of_axes():
    zarr = pytest.importorskip("zarr")
    data = zarr.array(numpy.ascontiguousarray(VALUES.T))
    data.attrs["_ARRAY_DIMENSIONS"] = ["lon", "lat", "lev"]
    volume, notes = notes_of(data)
    shown = numpy.where(VALUES == 0, numpy.nan, VALUES)  # 0 is the store's fill value
    assert numpy.array_equal(volume.array, shown, equal_nan=True)
    assert "which its store may have, are not read" in notes
    data.attrs["_ARRAY_DIMENSIONS"] = ["time", "lat", "lev"]
    with pytest.raises(pellucid.Error, match="\"time\" is time"):
        pellucid.Volume(data)
    data.attrs["_ARRAY_DIMENSIONS"] = ["lat", "lev"]
    volume, notes = notes_of(data)
    assert volume.array.shape == VALUES.T.shape and "2 names of axes" in notes
