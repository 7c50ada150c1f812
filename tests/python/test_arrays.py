# SPDX-License-Identifier: Apache-2.0
"""Arrays of every kind: the picture of the program of the same data, to the bit."""
import array
import ctypes
import gc
import warnings

import numpy
import pytest

import pellucid
from conftest import assert_same_bits, render, smooth

NATIVE = ["u1", "i1", "u2", "i2", "u4", "i4", "f4", "f8"]
CONVERTED = ["f2", "u8", "i8", "?"]


def address(a):
    return a.__array_interface__["data"][0]


def saved(tmp_path, values):
    path = tmp_path / "values.npy"
    numpy.save(path, values)
    return path


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", NATIVE + CONVERTED)
def test_types_and_byte_orders(program, tmp_path, kind, order):
    values = smooth(numpy.dtype(kind).newbyteorder(order))
    assert_same_bits(render(values), program.render(saved(tmp_path, values)))


@pytest.mark.parametrize("kind", NATIVE + ["?"])
def test_no_copy_of_what_lies_as_it_should(kind):
    values = smooth(kind)
    volume = pellucid.Volume(values)
    assert address(volume.array) == address(values)
    assert volume.array.base is not None and not volume.array.flags.writeable
    assert values.flags.writeable


def test_types_as_the_readers_have_them():
    assert pellucid.Volume(smooth("?")).type == "u8"
    assert pellucid.Volume(smooth("f2")).type == "f32"
    assert pellucid.Volume(smooth("i8")).type == "u8"
    assert pellucid.Volume(smooth("i8") - 1).type == "i8"
    assert pellucid.Volume(smooth("i8") * 1000).type == "u32"
    with pytest.warns(pellucid.Note, match="do not fit double"):
        assert pellucid.Volume(smooth("i8") + 2 ** 53).type == "f64"


def nrrd(path, memory, directions):
    """Writes the values as they lie, the fastest axis first with its direction (x, y, z)."""
    kinds = {"float32": "float", "int16": "short"}
    sizes = " ".join(str(n) for n in memory.shape[::-1])
    text = " ".join("(" + ",".join(repr(float(c)) for c in d) + ")" for d in directions)
    header = (f"NRRD0004\ntype: {kinds[memory.dtype.name]}\ndimension: 3\nsizes: {sizes}\n"
              f"space: left-posterior-superior\nspace directions: {text}\n"
              "space origin: (1,2,3)\nkinds: domain domain domain\nendian: little\n"
              "encoding: raw\n\n")
    path.write_bytes(header.encode() + memory.tobytes())
    return path


@pytest.mark.parametrize("axes", [(2, 1, 0), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1)])
def test_other_memory_orders_are_permutations_of_the_axes(program, tmp_path, axes):
    """numpy.transpose() of a C array, such as Fortran order: not copied, the same place."""
    memory = smooth("f4")
    values = memory.transpose(axes)
    volume = pellucid.Volume(values, spacing=(1, 2, 3), origin=(3, 2, 1))
    assert address(volume.array) == address(memory)
    assert volume.shape == values.shape and volume.spacing == (1, 2, 3)
    assert numpy.array_equal(volume.array, values)
    assert numpy.array_equal(volume.direction, numpy.eye(3))
    # World steps (x, y, z) of the array's axes (z, y, x), and of the memory's axes.
    steps = [(0, 0, 1), (0, 2, 0), (3, 0, 0)]
    of_memory = [steps[axes.index(m)] for m in (2, 1, 0)]
    expected = program.render(nrrd(tmp_path / "a.nrrd", memory, of_memory))
    assert_same_bits(render(volume), expected)
    # As near to the picture of a copy as both say that they are to the integral.
    copy = pellucid.Volume(numpy.ascontiguousarray(values), spacing=(1, 2, 3), origin=(3, 2, 1))
    assert render(copy).compare(render(volume)).over_errors == 0


@pytest.mark.parametrize("slices", [
    (slice(None, None, 2), slice(None), slice(None)), (slice(None), slice(1, -1), slice(None)),
    (slice(None, None, -1), slice(None), slice(None, None, -1))])
def test_strides_are_copied_once(program, tmp_path, slices):
    whole = smooth("i2", (9, 8, 10))
    values = whole[slices]
    expected = program.render(saved(tmp_path, numpy.ascontiguousarray(values)))
    volume = pellucid.Volume(values)
    whole[...] = 0  # not seen: it is a copy
    assert_same_bits(render(volume), expected)


def test_unaligned_memory_is_copied(program, tmp_path):
    values = smooth("f4")
    raw = numpy.empty(values.nbytes + 1, dtype=numpy.uint8)
    unaligned = raw[1:].view("f4").reshape(values.shape)
    unaligned[...] = values
    assert_same_bits(render(unaligned), program.render(saved(tmp_path, values)))


@pytest.mark.parametrize("kind", ["u1", "i2", "i4", "f4", "f8"])
def test_masked_values_are_vacuum(program, tmp_path, kind):
    values = smooth(kind)
    masked = numpy.ma.masked_greater(values, values.max() * 0.7)
    filled = values.astype("f4" if kind in ("u1", "i2", "f4") else "f8")
    filled[masked.mask] = numpy.nan
    assert_same_bits(render(masked), program.render(saved(tmp_path, filled)))
    assert not values.base and values.max() > 0  # not written to


def test_a_mask_of_nothing_costs_no_copy():
    values = smooth("u1")
    assert address(pellucid.Volume(numpy.ma.array(values)).array) == address(values)


class WithInterface:
    def __init__(self, values):
        self.values = values
        self.__array_interface__ = values.__array_interface__


class WithArray:
    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return self.values


class WithDLPack:
    def __init__(self, values):
        self.values = values

    def __dlpack__(self, stream=None):
        return self.values.__dlpack__()

    def __dlpack_device__(self):
        return self.values.__dlpack_device__()


def with_buffer(values):
    kind = {"f4": "f"}["f4"]
    flat = array.array(kind, values.ravel())
    return memoryview(flat).cast("B").cast(kind, values.shape)


@pytest.mark.parametrize("wrap", [WithInterface, WithArray, WithDLPack, with_buffer])
def test_protocols(program, tmp_path, wrap):
    values = smooth("f4")
    volume = pellucid.Volume(wrap(values))
    if wrap is not with_buffer:
        assert address(volume.array) == address(values)
    assert_same_bits(render(volume), program.render(saved(tmp_path, values)))


def test_memory_of_c_is_not_copied():
    memory = (ctypes.c_uint16 * (4 * 5 * 6))(*range(120))
    values = numpy.ctypeslib.as_array(memory).reshape(4, 5, 6)
    assert address(pellucid.Volume(values).array) == ctypes.addressof(memory)


def test_place(program, tmp_path):
    values = smooth("f4")
    path = saved(tmp_path, values)
    expected = program.render(path, "--spacing", "0.5,0.75,2", "--origin", "10,20,-30")
    image = render(pellucid.Volume(values, spacing=(2, 0.75, 0.5), origin=(-30, 20, 10)))
    assert_same_bits(image, expected)
    expected = program.render(path, "--centering", "cell")
    assert_same_bits(render(pellucid.Volume(values, centering="cell")), expected)
    assert pellucid.Volume(values, spacing=3).spacing == (3, 3, 3)


def test_direction_is_in_the_order_of_the_axes():
    turned = [[1, 0, 0], [0, 0, 1], [0, 1, 0]]  # axis y steps along x, and x along y
    volume = pellucid.Volume(smooth(), direction=turned, spacing=(1, 2, 3))
    corners = numpy.array(volume.corners)
    assert numpy.allclose(corners.max(axis=0), (2 * 8, 3 * 10, 1 * 6))
    assert numpy.array_equal(volume.direction, turned)


def test_rectilinear_axes():
    z = numpy.array([0, 1, 3, 4, 6, 7, 9.0])
    volume = pellucid.Volume(smooth(), coordinates=(z, None, None), spacing=None)
    assert numpy.array_equal(volume.coordinates[0], z)
    assert volume.coordinates[1] is None
    uniform = pellucid.Volume(smooth(), coordinates=(list(range(7)), None, None))
    assert uniform.coordinates == (None, None, None) and uniform.spacing == (1, 1, 1)
    descending = pellucid.Volume(smooth(), coordinates=(-z, None, None))
    assert numpy.array(descending.corners)[:, 2].min() == -9
    with pytest.raises(pellucid.Error, match="along z have the shape"):
        pellucid.Volume(smooth(), coordinates=(z[1:], None, None))
    with pytest.raises(pellucid.Error, match="do not go on in one direction"):
        pellucid.Volume(smooth(), coordinates=(z[[1, 0, 2, 3, 4, 5, 6]], None, None))


def test_nan_is_vacuum_and_infinity_is_refused():
    values = smooth()
    values[3, 4, 5] = numpy.nan
    assert pellucid.Volume(values).statistics["nan"] == 1
    values[3, 4, 5] = numpy.inf
    with pytest.raises(pellucid.Error, match="infinite"):
        pellucid.Volume(values)


@pytest.mark.parametrize("data, words", [
    (None, "expected an array, got None"),
    ("volume", "expected an array, got 'volume'"),
    (3.5, "0 axes"),
    (numpy.zeros(4), "1 axes"),
    (numpy.zeros((4, 4)), "2 axes"),
    (numpy.zeros((4, 4, 4, 2)), r"a\[..., 0\]"),
    (numpy.zeros((4, 4, 4), dtype=object), "astype"),
    (numpy.zeros((4, 4, 4), dtype=complex), "complex numbers"),
    (numpy.zeros((4, 4, 4), dtype="U3"), "text"),
    (numpy.zeros((4, 4, 4), dtype="M8[s]"), "times"),
    (numpy.zeros((4, 4, 4), dtype=[("a", "f4")]), "one field"),
    (numpy.zeros((4, 4, 4), dtype=numpy.longdouble), "astype"),
    (numpy.zeros((0, 4, 4)), "dimensions are"),
    (numpy.zeros((1, 4, 4)), "cell centering"),
    ([[1, 2], [3]], "expected an array"),
])
def test_what_is_refused_is_refused_in_one_line(data, words):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(pellucid.Error, match=words) as error:
            pellucid.Volume(data, name="data")
    assert "\n" not in str(error.value) and str(error.value).startswith("data:")


@pytest.mark.parametrize("options, words", [
    ({"spacing": (1, 1)}, "spacing: expected three numbers"),
    ({"spacing": (1, 0, 1)}, "spacing"),
    ({"spacing": (1, float("nan"), 1)}, "spacing"),
    ({"origin": "here"}, "origin: expected three numbers"),
    ({"direction": numpy.zeros((3, 3))}, "direction"),
    ({"direction": numpy.eye(4)}, "direction"),
    ({"centering": "edge"}, "centering"),
    ({"coordinates": 3}, "coordinates"),
])
def test_wrong_places_are_refused(options, words):
    with pytest.raises(pellucid.Error, match=words) as error:
        pellucid.Volume(smooth(), **options)
    assert "\n" not in str(error.value)


def test_huge_arrays_are_refused_before_memory_is_taken():
    huge = numpy.broadcast_to(numpy.float32(1), (2048, 65536, 65536))  # 32 TiB of one number
    with pytest.raises((pellucid.Error, MemoryError)):
        pellucid.Volume(huge)


def test_axes_of_one_entry_do_not_count():
    assert pellucid.Volume(smooth()[numpy.newaxis, ..., numpy.newaxis]).shape == (7, 9, 11)


def test_an_array_is_not_written_to():
    values = smooth()
    values.flags.writeable = False
    before = values.copy()
    render(values)
    gc.collect()
    assert numpy.array_equal(values, before)


def test_channels_and_labels_keep_the_order_of_an_array():
    values = numpy.asfortranarray(numpy.random.default_rng(3).random((3, 4, 5)))
    channels = pellucid.Channels(v=pellucid.Volume(values, spacing=(3, 2, 1)))
    assert channels["v"].shape == (3, 4, 5)
    assert tuple(channels["v"].spacing) == (3, 2, 1)
    assert numpy.array_equal(channels["v"].array, values)
    labels = numpy.asfortranarray(numpy.arange(60, dtype="u1").reshape(3, 4, 5))
    assert numpy.array_equal(pellucid.LabelVolume(labels).volume.array, labels)


def test_notes_blame_the_line_that_calls():
    """Of the package in Python, of its compiled part, and of the one called by the other."""
    values = numpy.full((3, 3, 3), 2 ** 60 + 1, dtype=numpy.int64)
    masked = numpy.ma.masked_equal(values, 5)
    masked[0, 0, 0] = 5
    for call in (lambda: pellucid.Volume(masked), lambda: pellucid.Volume(values),
                 lambda: pellucid.Channels(a=values), lambda: pellucid.render(values, size=4)):
        with pytest.warns(pellucid.Note) as told:
            call()
        assert told and {each.filename for each in told} == {__file__}


def test_masked_integers_that_are_rounded_are_told():
    values = numpy.arange(27, dtype=numpy.int64).reshape(3, 3, 3)
    values[0, 0, 0] = 2 ** 60 + 1
    masked = numpy.ma.masked_equal(values, 5)
    with pytest.warns(pellucid.Note, match="2\\^53"):
        pellucid.Volume(masked)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        values[0, 0, 0] = 2 ** 53
        pellucid.Volume(numpy.ma.masked_equal(values, 5))
