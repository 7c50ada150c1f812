#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders every data set there is without an option, and lays the pictures side by side.

  contact_sheet.py PROGRAM SHEET.png [--data FOLDER] [--page COLOR] [--only NAME,...] [OPTION...]

FOLDER holds the public data sets (default ../shared/data); those of Debian's mricron-data and the
built-in fields are taken too. COLOR is behind the pictures, which fill their tiles unless an OPTION
of the program, as --background transparent, leaves them open. What is not there is left out, and
said. Under each picture stands its name; the looks that the program took are printed, and of open
pictures which share of the larger side is seen.
"""
import argparse
import pathlib
import statistics
import subprocess
import sys
import tarfile
import tempfile

from PIL import Image, ImageDraw

TILE, COLUMNS, LINE = 240, 8, 14
BRAINS = pathlib.Path("/usr/share/mricron/templates")
# Name, file in the folder, arguments.
PUBLIC = [
    ("nucleon", "structured/nucleon/nucleon.nrrd"),
    ("hydrogenatom", "structured/hydrogenatom/hydrogenatom.dat"),
    ("fuel", "structured/fuel.nii.gz"), ("engine", "structured/engine.nii.gz"),
    ("bonsai", "structured/bonsai.nii.gz"),
    ("aneurism", "structured/aneurism/aneurism.raw.gz --dimensions 256,256,256 --type u8"),
    ("stent", "structured/stent.nrrd"),
    ("vismale", "structured/vismale/male.raw --dimensions 128,256,256 --type u8"),
    ("cranium", "structured/cranium_ct/matrix.dat --dimensions 256,256,108 --type i16 "
                "--spacing 0.957031,0.957031,1.5"),
    ("headsq", "structured/headsq/quarter.nhdr"), ("cthead", "structured/cthead_tiff"),
    ("HeadMR", "structured/HeadMRVolume/HeadMRVolume.mhd"), ("fmri", "structured/mha.mha"),
    ("mask", "structured/k3d_mask/mask.mhd"), ("ironProt", "structured/ironProt.vtk"),
    ("neghip", "structured/neghip.slc"), ("hydrogen", "structured/hydrogen.vti"),
    ("isabel", "structured/isabel_30.vti"), ("RectGrid2", "structured/RectGrid2.vtk"),
    ("avg152", "structured/avg152T1_LR_nifti.nii.gz"), ("hdz2000", "structured/hdz2000.npy"),
    ("FLAIR", "multivariate/ms_patient07/FLAIR.nii.gz"),
    ("T1", "multivariate/ms_patient07/T1.nii.gz"),
    ("T1POST", "multivariate/ms_patient07/T1POST.nii.gz"),
    ("T2", "multivariate/ms_patient07/T2.nii.gz"),
    ("GOLD", "multivariate/ms_patient07/GOLD.nii.gz"),
    ("mni_t1", "multivariate/mni_icbm152/mni_icbm152_t1_tal_nlin_sym_09a_converted.nii.gz"),
    ("mni_gm", "multivariate/mni_icbm152/mni_icbm152_gm_tal_nlin_sym_09a_converted.nii.gz"),
    ("Bi2O3", "multivariate/Bi2O3/Bi2O3.dat --component 0"),
    ("carotid", "multivariate/carotid.vtk"),
    ("FA", "multivariate/dti/FA.nii.gz"), ("vase", "multivariate/vase_4comp.vti --component 3"),
    ("ct_perfusion", "multivariate/ct_perfusion_rgb24.nii.gz --component 0"),
    ("kitchen", "multivariate/kitchen.vtk"), ("post", "unstructured/post.vtk"),
    ("fem", "unstructured/output_fem.vtu"), ("disk", "unstructured/disk_out_ref.ex2"),
    ("can", "unstructured/can.vtu"), ("hexa", "unstructured/hexa.vtk"),
    ("Tetrahedron", "unstructured/Tetrahedron.vtu"), ("notch", "unstructured/notch_disp.vtu"),
    ("smoke", "sparse_amr/smoke.vdb"), ("n2d_t1w", "dicom/n2d_t1w.tar.xz"),
    ("nifti_space", "conformance/nifti_space/RAS.nii.gz"),
]
TEMPLATES = ["ch2", "ch2bet", "ch2better", "inia19-t1-brain", "aal", "natbrainlab"]
FIELDS = ["sphere", "hydrogen", "marschner_lobb", "shells"]


def data_sets(folder, scratch):
    """Yields (name, arguments) of what is there."""
    for name, text in PUBLIC:
        file, *arguments = text.split()
        path = folder / file
        if not path.exists():
            print(f"{name}: {path} is not there", file=sys.stderr)
            continue
        if path.name.endswith(".tar.xz"):
            with tarfile.open(path) as packed:
                packed.extractall(scratch)
            path = scratch / path.name.removesuffix(".tar.xz")
        yield name, [str(path), *arguments]
    for name in TEMPLATES:
        path = BRAINS / f"{name}.nii.gz"
        if path.exists():
            yield name, [str(path)]
        else:
            print(f"{name}: {path} is not there", file=sys.stderr)
    for name in FIELDS:
        yield f"builtin:{name}", [f"builtin:{name}"]


def share_seen(picture):
    """The share of the larger side over which a picture has an opacity of 5 % or more."""
    box = picture.getchannel("A").point(lambda alpha: 255 if alpha >= 13 else 0).getbbox()
    return max(box[2] - box[0], box[3] - box[1]) / TILE if box else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("sheet")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--page", default="black")
    parser.add_argument("--only", default="")
    arguments, options = parser.parse_known_args()
    tiles, shares = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for name, source in data_sets(arguments.data, pathlib.Path(scratch)):
            if arguments.only and name not in arguments.only.split(","):
                continue
            picture = pathlib.Path(scratch) / "picture.png"
            picture.unlink(missing_ok=True)
            command = [arguments.program, "render", *source, "-o", str(picture)]
            done = subprocess.run([*command, "--size", str(TILE), *options], capture_output=True,
                                  text=True, check=False)
            lines = done.stderr.strip().splitlines()
            look = [line for line in lines if line.startswith("pellucid: look ")]
            text = (look or lines or [""])[0].removeprefix("pellucid: ").split(" (")[0]
            if picture.exists():
                with Image.open(picture) as image:
                    tiles.append((name, image.convert("RGBA")))
                    if image.mode == "RGBA":
                        shares.append(share_seen(image))
                        text += f", {shares[-1]:.0%} seen"
            print(f"{name}: {text}", flush=True)
    rows = (len(tiles) + COLUMNS - 1) // COLUMNS
    sheet = Image.new("RGB", (COLUMNS * TILE, rows * (TILE + LINE)), arguments.page)
    draw = ImageDraw.Draw(sheet)
    for i, (name, tile) in enumerate(tiles):
        x, y = i % COLUMNS * TILE, i // COLUMNS * (TILE + LINE)
        sheet.paste(tile, (x, y), tile)
        draw.text((x + 4, y + TILE + 1), name, fill="grey")
    sheet.save(arguments.sheet)
    print(f"{len(tiles)} pictures" +
          (f", median {statistics.median(shares):.0%} seen" if shares else ""))


if __name__ == "__main__":
    main()
