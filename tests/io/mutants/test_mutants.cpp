// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#ifdef PELLUCID_HAVE_HDF5
#include <hdf5.h>
#endif
#ifdef PELLUCID_HAVE_NETCDF
#include <netcdf.h>
#endif
#ifdef PELLUCID_HAVE_OPENVDB
#include <openvdb/openvdb.h>
#endif

#include "tests/io/dicom/dicom_files.h"
#ifdef PELLUCID_HAVE_HDF5
#include "tests/io/arrays/hdf5_files.h"
#endif
#include "mutants_test.h"
#include "pellucid/io/write_volume.h"
#include "tests/io/image_files.h"

namespace pellucid::test_mutants {
namespace {

using test::bytes_of;
using test::counting;

using test::MutantsTest;

test::DicomSliceFile dicom_slice(int k) {
  test::DicomSliceFile file;
  file.at("10\\20\\" + std::to_string(30 + 12 * k)).set(0x00281053, "1").set(0x00281052, "-9");
  file.pixels = std::string(40, static_cast<char>(k));
  return file;
}

TEST_F(MutantsTest, Dicom) {
  for (const int k : {0, 2}) write("slice" + std::to_string(k), dicom_slice(k).bytes());
  test::DicomSliceFile plain = dicom_slice(1), is_implicit = plain, big = plain, frames = plain;
  is_implicit.syntax = "1.2.840.10008.1.2";
  is_implicit.undefined_lengths = true;
  big.syntax = "1.2.840.10008.1.2.2";
  const test::DicomWriter w;
  frames.text[0x00280008] = {"IS", "2"};
  frames.pixels.resize(80);
  for (const char* place : {"1\\2\\3", "1\\2\\4"}) {
    frames.sequences[0x52009230].push_back(
        w.sequence(0x00209113, {w.element(0x00200032, "DS", place)}));
  }
  survive({plain.bytes(), is_implicit.bytes(), big.bytes(), frames.bytes()}, "slice1", folder_);
}

#ifdef PELLUCID_HAVE_GDCM
TEST_F(MutantsTest, CompressedDicom) {
  test::DicomSliceFile file = dicom_slice(0);
  file.syntax = "1.2.840.10008.1.2.5";
  file.encapsulated = true;
  file.pixels = test::fragments({test::run_length_encoded(std::vector<std::uint16_t>(20, 7))});
  write("slice1", dicom_slice(1).bytes());
  survive({file.bytes()}, "slice0", folder_);
}
#endif

TEST_F(MutantsTest, Tiff) {
  std::vector<std::string> seeds;
  for (const std::uint32_t compression : {1U, 8U}) {
    for (const bool tiled : {false, true}) {
      test::TiffFile file(tiled);
      for (int k = 0; k < 2; ++k) {
        test::TiffPage page = test::counting_page<std::uint16_t>(k, 1, tiled);
        if (tiled) {
          page.tiled = true;
          page.fields.erase(278);
          page.fields[322] = page.fields[323] = {16};
          page.strips[0].resize(512);
        }
        page.fields[259] = {compression};
        page.fields[317] = {compression == 8 ? 2U : 1U};
        if (compression == 8) page.strips[0] = test::deflated(page.strips[0], 15);
        file.add(page);
      }
      seeds.push_back(file.bytes());
    }
  }
  survive(seeds, "a.tif", path("a.tif"));
  survive(
      {test::described_tiff(4,
                            test::ome_xml({2, 2, 1},
                                          "<TiffData IFD=\"3\"/><TiffData FirstZ=\"1\" IFD=\"0\" "
                                          "PlaneCount=\"3\"/>")),
       test::described_tiff(4, "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\ncf=0\nc0=1\nc1=2\n"),
       test::described_tiff(4, R"({"shape": [2, 2, 4, 5], "axes": "ZCYX"})")},
      "a.tif", path("a.tif"));
}

TEST_F(MutantsTest, Png) {
  write("a1.png", test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(1)));
  survive({test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(0)),
           test::png(5, 4, 16, 0, test::page_values<std::uint16_t>(0, true)),
           test::png(5, 4, 8, 2, std::string(60, '\7')),
           test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(0), 0, "", "",
                     {{"sCAL", std::string("\0015e-4\0002.5E-4", 12)},
                      {"pCAL", std::string("d\0\0\0\0\0\0\0\0\xff\0\2m\0-10\00051", 20)}})},
          "a0.png", path("a0.png"));
}

TEST_F(MutantsTest, Mrc) {
  std::string header(1024, '\0');
  const auto put = [&](std::size_t word, auto value) {
    std::memcpy(&header[4 * (word - 1)], &value, 4);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    put(1 + i, std::int32_t{4});
    put(8 + i, std::int32_t{4});
    put(11 + i, 4.F);
    put(14 + i, 90.F);
    put(17 + i, static_cast<std::int32_t>(i + 1));
  }
  put(54, std::int32_t{0x4444});
  survive({header + std::string(64, '\1')}, "a.mrc", path("a.mrc"));
}

TEST_F(MutantsTest, Npy) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), }";
  header.resize(118, ' ');
  survive({std::string("\x93NUMPY\1\0\x76\0", 10) + header + bytes_of(counting())}, "a.npy",
          path("a.npy"));
}

TEST_F(MutantsTest, GzippedMrc) {
  std::string header(1024, '\0');
  header[0] = header[4] = header[8] = 4;
  survive({test::gzipped(header + std::string(64, '\1'))}, "a.mrc.gz", path("a.mrc.gz"));
}

TEST_F(MutantsTest, Slc) {
  const std::string header = "11111\n5 4 3 8\n1.5 2 0.25\n1 6 0 ";
  std::string runs = header + "1\n0 0 X";
  for (int z = 0; z < 3; ++z) {
    runs += "9 X" + std::string("\x85") + "12345" + "\x0f" + "\1" + std::string(1, '\0');
  }
  survive({header + "0\n2 1 Xicon!!" + bytes_of(counting<std::uint8_t>()), runs}, "a.slc",
          path("a.slc"));
}

TEST_F(MutantsTest, Dat) {
  write("v.raw", bytes_of(counting()));
  survive({"RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\nByteOrder: BigEndian\n"
           "BasisVector1: 1 0 0\nBasisVector2: 0 1 0\nBasisVector3: 0 0 1\nOffset: 1 2 3\n"
           "WorldVector1: 1 0 0 7\nDataRange: 0 100\nValueRange: -1 1\nUnit: K\n",
           "ObjectFileName: v.raw\nResolution: 5 4 3\nFormat: Vec2FLOAT16\nSliceThickness: 1 2 3\n",
           "RawFile: v.raw\nResolution: 5 3 2\nFormat: UINT64\n"},
          "a.dat", path("a.dat"));
}

TEST_F(MutantsTest, Ivf) {
  write("v.raw", bytes_of(counting()));
  survive({"<?xml version=\"1.0\" ?>\n<InviwoVolume version=\"2\"><RawFile content=\"v.raw\"/>"
           "<Format content=\"FLOAT32\"/><Dimension x=\"5\" y=\"4\" z=\"3\"/><ByteOffset "
           "content=\"0\"/><BasisAndOffset><col0 x=\"1\" y=\"0\" z=\"0\" w=\"0\"/><col1 x=\"0\" "
           "y=\"1\" z=\"0\" w=\"0\"/></BasisAndOffset></InviwoVolume>\n"},
          "a.ivf", path("a.ivf"));
}

#ifdef PELLUCID_HAVE_HDF5
TEST_F(MutantsTest, Hdf5) {
  const hid_t file = H5Fcreate(path("seed.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const std::array<hsize_t, 3> sides{3, 4, 5}, chunk{2, 2, 3};
  const hid_t space = H5Screate_simple(3, sides.data(), nullptr);
  for (const bool packed : {false, true}) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (packed) {
      H5Pset_chunk(how, 3, chunk.data());
      H5Pset_deflate(how, 9);
    }
    const hid_t set = H5Dcreate2(file, packed ? "packed" : "plain", H5T_IEEE_F32LE, space,
                                 H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, counting().data());
    H5Dclose(set);
    H5Pclose(how);
  }
  H5Sclose(space);
  H5Fclose(file);
  survive({read(path("seed.h5"))}, "a.h5", path("a.h5"));
}

TEST_F(MutantsTest, Hdf5OfImarisAndWithPositionsBeside) {
  test::ImarisFile{}.write(path("imaris"));
  {
    const test::Hdf5Writer file(path("beside"));
    file.add("v", H5T_IEEE_F32LE, {3, 4, 5}, counting<double>());
    file.add("affine", H5T_IEEE_F64LE, {4, 4}, {2, 0, 0, 1, 0, 3, 0, 2, 0, 0, 4, 3, 0, 0, 0, 1});
    file.add("spacing", H5T_IEEE_F32LE, {3}, {1, 2, 1});
    file.add("x", H5T_STD_I32LE, {3}, {0, 1, 2});
  }
  survive({read(path("imaris")), read(path("beside"))}, "a.h5", path("a.h5"));
}
#endif

#ifdef PELLUCID_HAVE_NETCDF
TEST_F(MutantsTest, NetCdf) {
  std::vector<std::string> seeds;
  for (const int mode : {NC_CLASSIC_MODEL, NC_64BIT_OFFSET, NC_NETCDF4}) {
    int file = 0, variable = 0;
    std::array<int, 3> axes{};
    nc_create(path("seed.nc").c_str(), NC_CLOBBER | mode, &file);
    nc_def_dim(file, "z", 3, &axes[0]);
    nc_def_dim(file, "y", 4, &axes[1]);
    nc_def_dim(file, "x", 5, &axes[2]);
    nc_def_var(file, "v", NC_FLOAT, 3, axes.data(), &variable);
    const double scale = 2;
    nc_put_att_double(file, variable, "scale_factor", NC_DOUBLE, 1, &scale);
    nc_enddef(file);
    nc_put_var_float(file, variable, counting().data());
    nc_close(file);
    seeds.push_back(read(path("seed.nc")));
  }
  survive({seeds[0], seeds[1]}, "a.nc", path("a.nc"));
  survive({seeds[2]}, "a.nc4", path("a.nc4"));
}
#endif

#ifdef PELLUCID_HAVE_OPENVDB
TEST_F(MutantsTest, OpenVdb) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(-1);
  grid->setName("density");
  for (int i = 0; i < 60; ++i) {
    grid->tree().setValueOn({i % 5, i / 5 % 4, i / 20}, static_cast<float>(i));
  }
  grid->fill({{16, 8, 8}, {23, 15, 15}}, 7, true);
  grid->pruneGrid();
  std::vector<std::string> seeds;
  const std::uint32_t masks = openvdb::io::COMPRESS_ACTIVE_MASK;
  for (const std::uint32_t packed :
       {std::uint32_t{openvdb::io::COMPRESS_NONE}, openvdb::io::COMPRESS_ZIP | masks,
        openvdb::io::COMPRESS_BLOSC | masks}) {
    openvdb::io::File file(path("seed.vdb").string());
    file.setCompression(packed);
    file.write(openvdb::GridPtrVec{grid});
    file.close();
    seeds.push_back(read(path("seed.vdb")));
  }
  // OpenVDB allocates what a damaged file says, up to the limit of its process.
  may_run_out_ = true;
  // OpenVDB goes round in circles in one of a hundred, which takes seconds to be ended.
  survive(seeds, "a.vdb", path("a.vdb"), 20);
}
#endif

TEST_F(MutantsTest, Mgh) {
  test::MghFile frames, coronal;
  frames.dimensions[3] = 2;
  coronal.good_ras = 0;
  const std::string values = test::swapped_bytes_of(counting());
  survive({frames.with(values + values), coronal.with(values)}, "a.mgh", path("a.mgh"));
  survive({test::gzipped(frames.with(values + values))}, "a.mgz", path("a.mgz"));
}

TEST_F(MutantsTest, NiftiTwoAndAnalyze) {
  test::NiftiTwoFile two, big;
  two.sform_code = 1;
  two.sform = {1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30};
  big.big_endian = true;
  survive({two.with(bytes_of(counting())), big.with(test::swapped_bytes_of(counting()))}, "a.nii",
          path("a.nii"));
  test::NiftiFile analyze;
  analyze.magic = std::string(4, '\0');
  analyze.vox_offset = 0;
  write("b.img", bytes_of(counting()));
  survive({analyze.header()}, "b.hdr", path("b.hdr"));
}

#ifdef PELLUCID_HAVE_ITK
TEST_F(MutantsTest, Nifti) {
  test::NiftiFile oblique;
  oblique.qform_code = 1;
  oblique.qform = {0.1F, 0.2F, 0.3F, 1, 2, 3};
  const std::string plain = test::NiftiFile{}.with(bytes_of(counting()));
  survive({plain, oblique.with(bytes_of(counting()))}, "a.nii", path("a.nii"));
  survive({test::gzipped(plain)}, "a.nii.gz", path("a.nii.gz"));
}

TEST_F(MutantsTest, Nrrd) {
  const std::string header =
      "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nendian: little\nspace: LPS\n"
      "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\nencoding: ";
  survive({header + "raw\n\n" + bytes_of(counting()),
           header + "gzip\n\n" + test::gzipped(bytes_of(counting())),
           header + "ascii\nkinds: domain domain domain\n\n1 2 3 4 5 6 7 8 9",
           "NRRD0005\ntype: float\ndimension: 4\nsizes: 5 4 3 1\nendian: little\nencoding: raw\n"
           "space: RAST\nspace directions: (1,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,1)\n"
           "space origin: (1,2,3,4)\n\n" +
               bytes_of(counting())},
          "a.nrrd", path("a.nrrd"));
}

TEST_F(MutantsTest, MetaImage) {
  const std::string header =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\nElementSpacing = 1 2 3\n"
      "DimSize = 5 4 3\nElementType = MET_FLOAT\n";
  survive({header + "ElementDataFile = LOCAL\n" + bytes_of(counting()),
           header + "CompressedData = True\nElementDataFile = LOCAL\n" +
               test::deflated(bytes_of(counting()), 15)},
          "a.mha", path("a.mha"));
}
#endif

}  // namespace
}  // namespace pellucid::test_mutants
