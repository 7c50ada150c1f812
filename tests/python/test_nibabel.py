# SPDX-License-Identifier: Apache-2.0
"""Every kind of image of nibabel: values as nibabel scales them, where its affine places them."""
import pathlib
import warnings

import numpy
import pytest

import pellucid
from conftest import smooth

nibabel = pytest.importorskip("nibabel")
DATA = pathlib.Path(nibabel.__file__).parent / "tests" / "data"
SHAPE = (3, 4, 5)  # i, j, k
AFFINE = numpy.array([[0, -2, 0, 7], [1.5, 0, 0, -4], [0, 0, 3, 2], [0, 0, 0, 1]])


def assert_shows(image, values, affine):
    """Voxel (i, j, k) has the value values[i, j, k], at affine @ (i, j, k), which is RAS."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", pellucid.Note)
        volume = pellucid.Volume(image)
    assert volume.shape == values.shape[::-1]
    assert numpy.allclose(volume.array, values.T, rtol=1e-6, atol=0)
    for index in [(0, 0, 0), tuple(side - 1 for side in values.shape), (1, 0, 0), (0, 1, 0)]:
        ras = (affine @ [*index, 1])[:3]
        place = numpy.array(volume.origin) + volume.direction @ (
            numpy.array(volume.spacing) * index[::-1])
        assert numpy.allclose(place[::-1], ras * [-1, -1, 1], atol=1e-4)


def voxels(kind="i2"):
    return smooth(kind, SHAPE)


@pytest.mark.parametrize("name", ["Nifti1Image", "Nifti2Image", "MGHImage"])
def test_images_that_state_their_place(tmp_path, name):
    image = getattr(nibabel, name)(voxels(), AFFINE)
    assert_shows(image, voxels(), AFFINE)
    path = tmp_path / ("a.mgz" if name == "MGHImage" else "a.nii")
    nibabel.save(image, path)
    assert_shows(nibabel.load(path), voxels(), AFFINE)
    part = nibabel.load(path).slicer[1:, :, ::2]
    assert_shows(part, voxels()[1:, :, ::2], part.affine)
    assert numpy.allclose(part.affine[:3, 3], (AFFINE @ [1, 0, 0, 1])[:3])


@pytest.mark.parametrize("name", ["AnalyzeImage", "Spm99AnalyzeImage", "Spm2AnalyzeImage"])
def test_images_without_orientation_are_told(tmp_path, name):
    image = getattr(nibabel, name)(voxels(), None)
    with pytest.raises(pellucid.Error, match="affine is None"):
        pellucid.Volume(image)
    nibabel.save(image, tmp_path / "a.img")
    with pytest.warns(pellucid.Note, match="states no orientation"):
        pellucid.Volume(nibabel.load(tmp_path / "a.img"))
    # SPM's images have a matrix beside them.
    if name != "AnalyzeImage":
        pytest.importorskip("scipy")
        nibabel.save(getattr(nibabel, name)(voxels(), AFFINE), tmp_path / "b.img")
        assert_shows(nibabel.load(tmp_path / "b.img"), voxels(), AFFINE)


def test_nifti_without_codes_is_told(tmp_path):
    nibabel.save(nibabel.Nifti1Image(voxels(), AFFINE), tmp_path / "a.nii")
    content = bytearray((tmp_path / "a.nii").read_bytes())
    content[252:256] = bytes(4)  # qform_code and sform_code
    (tmp_path / "a.nii").write_bytes(bytes(content))
    with pytest.warns(pellucid.Note, match="states no orientation"):
        pellucid.Volume(nibabel.load(tmp_path / "a.nii"))


@pytest.mark.parametrize("code, scale", [("meter", 1000), ("mm", 1), ("micron", 0.001)])
def test_units_are_those_of_the_reader(tmp_path, code, scale):
    image = nibabel.Nifti1Image(voxels(), AFFINE)
    image.header.set_xyzt_units(code)
    moved = numpy.diag([scale, scale, scale, 1]) @ AFFINE
    assert_shows(image, voxels(), moved)
    nibabel.save(image, tmp_path / "a.nii")
    spacing = pellucid.read(tmp_path / "a.nii").spacing
    assert spacing == pytest.approx(pellucid.Volume(image).spacing)


def test_a_slope_that_is_set_after_loading_is_for_saving(tmp_path):
    nibabel.save(nibabel.Nifti1Image(voxels(), AFFINE), tmp_path / "a.nii")
    image = nibabel.load(tmp_path / "a.nii")
    image.header.set_slope_inter(2, 5)
    assert_shows(image, voxels(), AFFINE)


def afni(folder, factors, values):
    """Writes a file of AFNI whose sub-bricks have factors of their own."""
    values = numpy.asarray(values, dtype="<i2")
    lists = {
        "DATASET_RANK": ("integer", [3, len(factors), 0, 0, 0, 0, 0, 0]),
        "DATASET_DIMENSIONS": ("integer", [*values.shape[:3], 0, 0]),
        "SCENE_DATA": ("integer", [0, 2, 0, 0, 0, 0, 0, 0]),
        "ORIENT_SPECIFIC": ("integer", [0, 3, 4]),  # R to L, P to A, I to S
        "ORIGIN": ("float", [10.0, -20.0, 30.0]),
        "DELTA": ("float", [2.0, 3.0, 4.0]),
        "IJK_TO_DICOM_REAL": ("float", [2, 0, 0, 10, 0, -3, 0, 20, 0, 0, 4, 30]),
        "BRICK_TYPES": ("integer", [1] * len(factors)),
        "BRICK_FLOAT_FACS": ("float", factors),
    }
    text = "".join(f"\ntype = {kind}-attribute\nname = {name}\ncount = {len(numbers)}\n "
                   + " ".join(map(str, numbers)) + "\n" for name, (kind, numbers) in lists.items())
    for name, word in [("BYTEORDER_STRING", "LSB_FIRST"), ("TYPESTRING", "3DIM_HEAD_ANAT"),
                       ("TEMPLATE_SPACE", "ORIG")]:
        text += f"\ntype = string-attribute\nname = {name}\ncount = {len(word) + 1}\n'{word}~\n"
    (folder / "a+orig.HEAD").write_text(text)
    (folder / "a+orig.BRIK").write_bytes(values.tobytes(order="F"))
    return nibabel.load(folder / "a+orig.HEAD")


@pytest.mark.parametrize("factor", [0, 0.25, 3e-4])
def test_afni_scales_its_bricks(tmp_path, factor):
    image = afni(tmp_path, [factor], voxels())
    # To RAS from AFNI's DICOM order, which is LPS; a factor of 0 is none.
    affine = numpy.array([[-2, 0, 0, -10], [0, 3, 0, -20], [0, 0, 4, 30], [0, 0, 0, 1]])
    assert_shows(image, voxels() * (factor or 1), affine)


def test_each_brick_of_afni_has_its_own_factor(tmp_path):
    several = numpy.stack([voxels(), voxels()], axis=-1)
    image = afni(tmp_path, [0.5, 2.0], several)
    with pytest.raises(pellucid.Error, match=r"image.slicer\[..., 0\]"):
        pellucid.Volume(image)
    assert_shows(image.slicer[..., 1], voxels() * 2.0, image.affine)


def test_par_rec():
    """Slices with slopes of their own, which stand in the text: value = RS * stored + RI."""
    path = DATA / "phantom_varscale.PAR"
    if not path.exists():
        pytest.skip("nibabel came without its test data")
    rows = [line.split() for line in path.read_text().splitlines()
            if line.strip() and line.strip()[0].isdigit()]
    stored = numpy.frombuffer(path.with_suffix(".REC").read_bytes(), "<i2").reshape(-1, 64, 64)
    first = [row for row in rows if row[2] == rows[0][2]]  # of one dynamic
    values = numpy.stack([float(row[12]) * stored[int(row[6])].T + float(row[11]) for row in first],
                         axis=-1)
    image = nibabel.load(path)
    with pytest.raises(pellucid.Error, match="4 axes"):
        pellucid.Volume(image)
    shown = image.slicer[..., 0]
    assert_shows(shown, values, image.affine)


@pytest.mark.parametrize("name, libraries", [
    ("tiny.mnc", ["scipy"]), ("small.mnc", ["h5py"]), ("scaled+tlrc.HEAD", []), ("test.mgz", []),
    ("anatomical.nii", []), ("standard.nii.gz", []), ("example4d.nii.gz", []),
    ("example_nifti2.nii.gz", []), ("tinypet.v", []), ("phantom_EPI_asc_CLEAR_2_1.PAR", []),
    ("minc1_4d.mnc", ["scipy"]), ("minc2_4d.mnc", ["h5py"]),
])
def test_files_of_every_kind(name, libraries):
    for library in libraries:
        pytest.importorskip(library)
    if not (DATA / name).exists():
        pytest.skip("nibabel came without its test data")
    if name.endswith(".v"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            image = nibabel.ecat.load(DATA / name)
    else:
        image = nibabel.load(DATA / name)
    values = numpy.asarray(image.dataobj)
    if "_4d" in name:  # MINC has time in front
        with pytest.raises(pellucid.Error, match=r"dataobj\[0\]"):
            pellucid.Volume(image)
        image, values = nibabel.Nifti1Image(image.dataobj[0], image.affine), values[0]
    elif values.ndim > 3 and values.shape[3] > 1:
        image, values = image.slicer[..., 0], values[..., 0]
    assert_shows(image, values.reshape(values.shape[:3]), image.affine)


def test_axes_of_one_entry_in_front_are_of_space():
    sagittal = nibabel.Nifti1Image(numpy.zeros((1, 4, 5, 6), dtype="f4"), AFFINE)
    with pytest.raises(pellucid.Error, match="4 axes"):
        pellucid.Volume(sagittal)
    last = nibabel.Nifti1Image(voxels("f4")[..., numpy.newaxis, numpy.newaxis], AFFINE)
    assert_shows(last, voxels("f4"), AFFINE)
    vectors = nibabel.Nifti1Image(numpy.zeros((*SHAPE, 1, 3), dtype="f4"), AFFINE)
    with pytest.raises(pellucid.Error, match=r"slicer\[..., 0, 0\]"):
        pellucid.Volume(vectors)


def test_values_without_their_image_are_refused(tmp_path):
    """Their axes are x, y and z, and they have no place."""
    nibabel.save(nibabel.Nifti1Image(voxels(), AFFINE), tmp_path / "a.nii")
    image = nibabel.load(tmp_path / "a.nii")
    for show in (pellucid.Volume, pellucid.LabelVolume):
        with pytest.raises(pellucid.Error, match="give the image"):
            show(image.dataobj)
    assert_shows(image, voxels(), AFFINE)
    assert pellucid.Volume(numpy.asarray(image.dataobj)).shape == SHAPE


def test_what_is_no_image_of_voxels_is_refused():
    axes = (nibabel.cifti2.ScalarAxis(["a", "b"]), nibabel.cifti2.SeriesAxis(0, 1, 5))
    with pytest.raises(pellucid.Error, match="Cifti2Image, whose axes"):
        pellucid.Volume(nibabel.Cifti2Image(numpy.zeros((2, 5), dtype="f4"), axes))
    with pytest.raises(pellucid.Error, match="expected an array"):
        pellucid.Volume(nibabel.GiftiImage())
    flat = nibabel.Nifti1Image(numpy.zeros((4, 5), dtype="f4"), AFFINE)
    with pytest.raises(pellucid.Error, match="2 axes"):
        pellucid.Volume(flat)


@pytest.mark.parametrize("kind, words", [("c8", "complex"), ("rgb", "one field")])
def test_voxels_of_other_types_are_refused(tmp_path, kind, words):
    """Also where a slope would make numbers of them."""
    values = numpy.zeros(SHAPE, dtype=[(c, "u1") for c in "RGB"] if kind == "rgb" else kind)
    nibabel.save(nibabel.Nifti1Image(values, AFFINE), tmp_path / "a.nii")
    content = bytearray((tmp_path / "a.nii").read_bytes())
    content[112:116] = numpy.float32(2).tobytes()
    (tmp_path / "a.nii").write_bytes(bytes(content))
    with pytest.raises(pellucid.Error, match=words):
        pellucid.Volume(nibabel.load(tmp_path / "a.nii"))
