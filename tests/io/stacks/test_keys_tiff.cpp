// SPDX-License-Identifier: Apache-2.0

// Rows of the tables "TIFF, OME-TIFF and ImageJ" and "Stacks of files" of
// docs/reference/formats.md.

#include <cstring>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/described_keys.h"
#include "tests/io/image_files.h"

namespace pellucid::test_keys_tiff {
namespace {

using test::contains;
using test::described_tiff;
using test::page_order;
using test::TiffPage;

constexpr const char* tiff_rows = "TIFF, OME-TIFF and ImageJ";
constexpr const char* stack_rows = "Stacks of files";

std::vector<Volume> noting(const std::filesystem::path& file, std::vector<std::string>& notes,
                           ReadOptions options = {}) {
  options.note = [&notes](const std::string& text) { notes.push_back(text); };
  return read_components(file, options);
}

/// Two pages, the first of which is changed.
template <class Change>
std::string changed(const Change& change) {
  test::TiffFile file(false);
  for (int k = 0; k < 2; ++k) {
    TiffPage page = test::counting_page<std::uint16_t>(k, 1);
    if (k == 0) change(page);
    file.add(page);
  }
  return file.bytes();
}

std::string imagej(int pages, const std::string& lines) {
  return described_tiff(pages, "ImageJ=1.53t\n" + lines);
}

PELLUCID_DESCRIBED_KEY(tiff_resolution, tiff_rows, "XResolution", honored) {
  const auto bytes = changed([](TiffPage& page) {
    page.rationals = {{282, 20}, {283, 40}};
    page.fields[296] = {3};
  });
  const Volume volume = read_volume(write("a.tif", bytes));
  test::expect_near(volume.description().placement.spacing, {0.5, 0.25, 1});
}
PELLUCID_DESCRIBED_KEY(tiff_aspect, tiff_rows, "ResolutionUnit 1", told) {
  const auto with = [&](double x, double y) {
    std::vector<std::string> notes;
    noting(write("a.tif", changed([&](TiffPage& page) {
                   page.rationals = {{282, x}, {283, y}};
                   page.fields[296] = {1};
                 })),
           notes);
    return notes;
  };
  expect_told(with(100, 50), "pixels 2 times as high as wide");
  expect_told(with(1, 3), "pixels 0.3333 times as high as wide");
  for (const std::string& note : with(72, 72)) EXPECT_FALSE(contains(note, "as high as")) << note;
}
PELLUCID_DESCRIBED_KEY(ome_type, tiff_rows, "Type", told) {
  const auto with = [&](const std::string& type) {
    std::string xml = test::ome_xml({2, 1, 1}, "<TiffData/>");
    const std::string was = "Type=\"uint16\"";
    EXPECT_TRUE(contains(xml, was)) << xml;
    xml.replace(xml.find(was), was.size(), "Type=\"" + type + "\"");
    std::vector<std::string> notes;
    noting(write("a.ome.tif", described_tiff(2, xml)), notes);
    return notes;
  };
  expect_told(with("int16"), "says values of int16, but its pages have u16");
  expect_told(with("float"), "says values of float");
  for (const std::string& note : with("uint16")) EXPECT_FALSE(contains(note, "values of")) << note;
}
PELLUCID_DESCRIBED_KEY(ome_modulo, tiff_rows, "ModuloAlongZ", told) {
  std::string xml = test::ome_xml({2, 1, 1}, "<TiffData/>");
  xml.insert(xml.rfind("</OME>"),
             "<StructuredAnnotations><XMLAnnotation><Value><Modulo><ModuloAlongZ Type=\"angle\"/>"
             "</Modulo></Value></XMLAnnotation></StructuredAnnotations>");
  std::vector<std::string> notes;
  noting(write("a.ome.tif", described_tiff(2, xml)), notes);
  expect_told(notes, "ModuloAlongZ");
}
PELLUCID_DESCRIBED_KEY(tiff_orientation, tiff_rows, "Orientation", told) {
  for (const std::uint32_t orientation : {2U, 4U, 8U}) {
    const auto bytes = changed([&](TiffPage& page) { page.fields[274] = {orientation}; });
    std::vector<std::string> notes;
    noting(write("a.tif", bytes), notes);
    expect_told(notes, "Orientation is " + std::to_string(orientation));
  }
}
PELLUCID_DESCRIBED_KEY(tiff_inverted, tiff_rows, "PhotometricInterpretation", told) {
  const auto bytes = changed([](TiffPage& page) { page.fields[262] = {0}; });
  std::vector<std::string> notes;
  noting(write("a.tif", bytes), notes);
  expect_told(notes, "small values are meant to be bright");
}
PELLUCID_DESCRIBED_KEY(tiff_subfile, tiff_rows, "NewSubfileType", honored) {
  test::TiffFile file(false);
  for (int k = 0; k < 3; ++k) {
    TiffPage page = test::counting_page<std::uint16_t>(k, 1);
    page.fields[254] = {k == 1 ? 1U : 2U};
    file.add(page);
  }
  EXPECT_EQ(page_order(read_components(write("a.tif", file.bytes()))), "0 2");
}
PELLUCID_DESCRIBED_KEY(tiff_no_data, tiff_rows, "GDAL_NODATA", told) {
  const auto bytes = changed([](TiffPage& page) { page.texts[42113] = "-9999"; });
  std::vector<std::string> notes;
  noting(write("a.tif", bytes), notes);
  expect_told(notes, "GDAL_NODATA says that -9999 is no value");
}
PELLUCID_DESCRIBED_KEY(tiff_gdal, tiff_rows, "GDAL_METADATA", told) {
  const auto bytes = changed([](TiffPage& page) {
    page.texts[42112] =
        "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>";
  });
  std::vector<std::string> notes;
  noting(write("a.tif", bytes), notes);
  expect_told(notes, "GDAL_METADATA has a scale or an offset");
}
PELLUCID_DESCRIBED_KEY(tiff_geo, tiff_rows, "ModelPixelScale", told) {
  const auto bytes = changed([](TiffPage& page) { page.records[33550] = std::string(24, '\0'); });
  std::vector<std::string> notes;
  noting(write("a.tif", bytes), notes);
  expect_told(notes, "ModelPixelScale");
}
PELLUCID_DESCRIBED_KEY(tiff_fluoview, tiff_rows, "FluoView", told) {
  const auto bytes = changed([](TiffPage& page) { page.records[34361] = "header"; });
  std::vector<std::string> notes;
  noting(write("a.tif", bytes), notes);
  expect_told(notes, "description by FluoView (tag 34361) is not read");
}
PELLUCID_DESCRIBED_KEY(tiff_metamorph, tiff_rows, "UIC2", refused) {
  const auto bytes = changed([](TiffPage& page) { page.records[33629] = std::string(12, '\1'); });
  const auto file = write("a.tif", bytes);
  expect_refused([&] { read_volume(file); }, "MetaMorph, whose 12 planes share one page");
}

PELLUCID_DESCRIBED_KEY(ome_tiff_data, tiff_rows, "TiffData", honored) {
  const std::string xml =
      test::ome_xml({2, 1, 1}, "<TiffData IFD=\"1\"/><TiffData FirstZ=\"1\" IFD=\"0\"/>");
  EXPECT_EQ(page_order(read_components(write("a.ome.tif", described_tiff(2, xml)))), "1 0");
}
PELLUCID_DESCRIBED_KEY(ome_sizes, tiff_rows, "SizeZ, SizeC, SizeT", honored) {
  const std::string xml = test::ome_xml({2, 2, 1}, "<TiffData/>");
  EXPECT_EQ(page_order(read_components(write("a.ome.tif", described_tiff(4, xml)))), "0 1, 2 3");
  expect_refused([&] { read_components(write("a.ome.tif", described_tiff(3, xml))); },
                 "2 slices of 2 channels");
}
PELLUCID_DESCRIBED_KEY(ome_order, tiff_rows, "DimensionOrder", honored) {
  const std::string xml = test::ome_xml({2, 2, 1}, "<TiffData/>", "", "XYCZT");
  EXPECT_EQ(page_order(read_components(write("a.ome.tif", described_tiff(4, xml)))), "0 2, 1 3");
}
PELLUCID_DESCRIBED_KEY(ome_file, tiff_rows, "UUID FileName", honored) {
  const std::string xml = test::ome_xml(
      {2, 1, 1},
      "<TiffData IFD=\"0\"><UUID FileName=\"b.ome.tif\">urn:uuid:b</UUID></TiffData>"
      "<TiffData IFD=\"0\" FirstZ=\"1\"><UUID FileName=\"a.ome.tif\">urn:uuid:a</UUID>"
      "</TiffData>");
  write("b.ome.tif", described_tiff(1, xml, {4}));
  EXPECT_EQ(page_order(read_components(write("a.ome.tif", described_tiff(1, xml, {6})))), "4 6");
}
PELLUCID_DESCRIBED_KEY(ome_metadata_file, tiff_rows, "BinaryOnly MetadataFile", honored) {
  write("m.companion.ome",
        test::ome_xml({2, 1, 1}, "<TiffData IFD=\"1\"/><TiffData FirstZ=\"1\" IFD=\"0\"/>"));
  const auto file =
      write("a.ome.tif", described_tiff(2,
                                        "<OME><BinaryOnly MetadataFile=\"m.companion.ome\" "
                                        "UUID=\"u\"/></OME>"));
  EXPECT_EQ(page_order(read_components(file)), "1 0");
}
PELLUCID_DESCRIBED_KEY(ome_channel, tiff_rows, "Channel Name", honored) {
  const std::string xml =
      test::ome_xml({2, 2, 1}, "<Channel Name=\"DAPI\"/><Channel Name=\"GFP\"/><TiffData/>");
  ReadOptions options;
  options.component_name = "GFP";
  const auto file = write("a.ome.tif", described_tiff(4, xml));
  EXPECT_EQ(page_order(read_components(file, options)), "2 3");
}
PELLUCID_DESCRIBED_KEY(ome_physical, tiff_rows, "PhysicalSizeX", honored) {
  const std::string xml =
      test::ome_xml({2, 1, 1}, "<TiffData/>",
                    "PhysicalSizeX=\"1\" PhysicalSizeY=\"2\" PhysicalSizeZ=\"3\" "
                    "PhysicalSizeZUnit=\"mm\"");
  const Volume volume = read_volume(write("a.ome.tif", described_tiff(2, xml)));
  test::expect_near(volume.description().placement.spacing, {1, 2, 3000});
  for (const char* said : {"PhysicalSizeZ=\"0,5\"", "PhysicalSizeX=\"1 um\"",
                           "PhysicalSizeY=\"-1\"", "TimeIncrement=\"2s\""}) {
    std::vector<std::string> notes;
    noting(write("a.ome.tif", described_tiff(2, test::ome_xml({2, 1, 1}, "<TiffData/>", said))),
           notes);
    expect_told(notes, std::string(said) + ", which is no");
  }
}
PELLUCID_DESCRIBED_KEY(ome_time, tiff_rows, "TimeIncrement", honored) {
  const std::string xml = test::ome_xml({2, 1, 2}, "<TiffData/>", "TimeIncrement=\"10\"");
  ReadOptions options;
  options.time = 6;
  const auto file = write("a.ome.tif", described_tiff(4, xml));
  EXPECT_EQ(page_order(read_components(file, options)), "2 3");
}
PELLUCID_DESCRIBED_KEY(ome_position, tiff_rows, "PositionZ", told) {
  const std::string xml = test::ome_xml(
      {2, 1, 1},
      "<TiffData/><Plane TheZ=\"0\" TheC=\"0\" TheT=\"0\" PositionZ=\"7\"/><Plane TheZ=\"1\" "
      "TheC=\"0\" TheT=\"0\" PositionZ=\"5\"/>");
  std::vector<std::string> notes;
  noting(write("a.ome.tif", described_tiff(2, xml)), notes);
  expect_told(notes, "PositionZ go down with z");
  const auto with = [&](const std::string& pixels, const std::string& first,
                        const std::string& second) {
    const auto plane = [](int z, const std::string& more) {
      return "<Plane TheZ=\"" + std::to_string(z) + "\" TheC=\"0\" TheT=\"0\" " + more + "/>";
    };
    const std::string inside = "<TiffData/>" + plane(0, first) + plane(1, second);
    std::vector<std::string> told;
    noting(write("a.ome.tif", described_tiff(2, test::ome_xml({2, 1, 1}, inside, pixels))), told);
    return told;
  };
  const std::string sizes = "PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" PhysicalSizeZ=\"2\"";
  // Positions without a unit are of the frame of reference.
  expect_told(with(sizes, "PositionZ=\"0\"", "PositionZ=\"5\""),
              "PositionZ are 5 (without a unit) apart, another distance than PhysicalSizeZ");
  expect_told(with(sizes, "PositionZ=\"0\" PositionZUnit=\"reference frame\"",
                   "PositionZ=\"5\" PositionZUnit=\"reference frame\""),
              "another distance than PhysicalSizeZ");
  expect_told(
      with(sizes, "PositionZ=\"0\" PositionZUnit=\"nm\"", "PositionZ=\"2\" PositionZUnit=\"nm\""),
      "PositionZ are 2 nm apart, another distance");
  for (const std::string unit : {"", " PositionZUnit=\"\u00b5m\""}) {
    for (const auto& note : with(sizes, "PositionZ=\"3\"" + unit, "PositionZ=\"5\"" + unit)) {
      EXPECT_FALSE(contains(note, "PositionZ")) << note;
    }
  }
  expect_told(with("", "PositionZ=\"0\"", "PositionZ=\"5\""), "in no unit of length");
  // The stage moved aside by four pixels.
  expect_told(with(sizes, "PositionX=\"0\" PositionZ=\"0\"", "PositionX=\"2\" PositionZ=\"2\""),
              "PositionX differ by 4 pixels");
}
PELLUCID_DESCRIBED_KEY(ome_images, tiff_rows, "Image Name", honored) {
  std::string xml = test::ome_xml({2, 1, 1}, "<TiffData IFD=\"0\" PlaneCount=\"2\"/>");
  const std::string second =
      "<Image Name=\"b\"><Pixels DimensionOrder=\"XYZCT\" SizeX=\"5\" SizeY=\"4\" SizeZ=\"2\" "
      "SizeC=\"1\" SizeT=\"1\"><TiffData IFD=\"2\" PlaneCount=\"2\"/></Pixels></Image></OME>";
  xml.replace(xml.find("</OME>"), 6, second);
  const auto file = write("a.ome.tif", described_tiff(4, xml));
  std::vector<std::string> notes;
  noting(file, notes);
  expect_told(notes, "the first is read");
  ReadOptions options;
  options.series = "b";
  EXPECT_EQ(page_order(read_components(file, options)), "2 3");
}

PELLUCID_DESCRIBED_KEY(ij_counts, tiff_rows, "channels, slices, frames", honored) {
  const auto file = write("a.tif", imagej(8, "images=8\nchannels=2\nslices=2\nframes=2\n"));
  EXPECT_EQ(page_order(read_components(file)), "0 2, 1 3, 4 6, 5 7");
}
PELLUCID_DESCRIBED_KEY(ij_images, tiff_rows, "images", honored) {
  EXPECT_EQ(page_order(read_components(write("a.tif", imagej(3, "images=3\n")))), "0 1 2");
  expect_refused([&] { read_components(write("a.tif", imagej(3, "images=5\n"))); },
                 "the file has 3 pages");
  expect_refused([&] { read_components(write("a.tif", imagej(6, "images=6abc\n"))); },
                 "images=6abc");
}
PELLUCID_DESCRIBED_KEY(ij_units, tiff_rows, "unit, yunit, zunit", honored) {
  const auto bytes = changed([](TiffPage& page) {
    page.description = "ImageJ=1.53t\nimages=2\nunit=mm\nyunit=cm\nzunit=um\nspacing=500\n";
    page.rationals = {{282, 2}, {283, 2}};
  });
  const Volume volume = read_volume(write("a.tif", bytes));
  test::expect_near(volume.description().placement.spacing, {0.5, 5, 0.5});
}
PELLUCID_DESCRIBED_KEY(ij_spacing, tiff_rows, "spacing", honored) {
  const Volume volume = read_volume(write("a.tif", imagej(2, "images=2\nspacing=2.5\n")));
  EXPECT_EQ(volume.description().placement.spacing.z, 2.5);
  for (const char* word : {"spacing=2,5", "spacing=2.5um", "xorigin=a", "finterval=1s"}) {
    std::vector<std::string> notes;
    noting(write("a.tif", imagej(2, "images=2\n" + std::string(word) + "\n")), notes);
    expect_told(notes, std::string(word) + ", which is no number");
  }
}
PELLUCID_DESCRIBED_KEY(ij_interval, tiff_rows, "finterval, fps", honored) {
  ReadOptions options;
  options.time = 6;
  for (const char* step : {"finterval=10\n", "fps=0.1\n"}) {
    const auto file =
        write("a.tif", imagej(4, std::string("images=4\nslices=2\nframes=2\n") + step));
    EXPECT_EQ(page_order(read_components(file, options)), "2 3");
  }
}
PELLUCID_DESCRIBED_KEY(ij_line, tiff_rows, "cf=0, c0, c1", honored) {
  const Volume volume = read_volume(write("a.tif", imagej(2, "images=2\ncf=0\nc0=-5\nc1=2\n")));
  EXPECT_EQ(test::value_at(volume, 4, 3, 1), 2 * 39 - 5);
}
PELLUCID_DESCRIBED_KEY(ij_curve, tiff_rows, "cf=1 and above", told) {
  std::vector<std::string> notes;
  noting(write("a.tif", imagej(2, "images=2\ncf=4\nc0=1\nc1=2\nc2=3\n")), notes);
  expect_told(notes, "cf=4");
}
PELLUCID_DESCRIBED_KEY(ij_value_unit, tiff_rows, "vunit", told) {
  std::vector<std::string> notes;
  noting(write("a.tif", imagej(2, "images=2\nvunit=gray\n")), notes);
  expect_told(notes, "vunit");
}
PELLUCID_DESCRIBED_KEY(ij_origin, tiff_rows, "xorigin, yorigin, zorigin", honored) {
  const Volume volume =
      read_volume(write("a.tif", imagej(2, "images=2\nspacing=2\nxorigin=1\nzorigin=3\n")));
  test::expect_near(volume.description().placement.origin, {-1, 0, -6});
}
PELLUCID_DESCRIBED_KEY(ij_inverty, tiff_rows, "inverty", told) {
  std::vector<std::string> notes;
  noting(write("a.tif", imagej(2, "images=2\ninverty=true\n")), notes);
  expect_told(notes, "inverty");
}
PELLUCID_DESCRIBED_KEY(ij_unknown, tiff_rows, "other lines of ImageJ", told) {
  std::vector<std::string> notes;
  noting(write("a.tif", imagej(2, "images=2\nparrot=1\n")), notes);
  expect_told(notes, "parrot");
}
PELLUCID_DESCRIBED_KEY(scifio_axes, tiff_rows, "axes, lengths", honored) {
  const auto file =
      write("a.tif", described_tiff(4, "SCIFIO=1\naxes=X,Y,Channel,Z\nlengths=5,4,2,2\n"));
  EXPECT_EQ(page_order(read_components(file)), "0 2, 1 3");
  const auto notes_of = [&](const std::string& lines) {
    std::vector<std::string> notes;
    noting(write("a.tif", described_tiff(2, "SCIFIO=1\n" + lines)), notes);
    return notes;
  };
  expect_told(notes_of("axes=X,Y,Z\nlengths=6,4,2\n"), "6 pixels along X (SCIFIO lengths)");
  expect_told(notes_of("axes=X,Y,Z\nlengths=5,7,2\n"), "but its pages have 4");
  expect_told(notes_of("axes=X,Y,Z\nlengths=5,4\n"), "3 axes and 2 lengths");
  expect_told(notes_of("axes=X,Y,Z\nlengths=5,4,2\nscales=1,2,3;5\n"), "scale 3;5");
}
PELLUCID_DESCRIBED_KEY(scifio_scales, tiff_rows, "scales, units", honored) {
  const auto file = write("a.tif", described_tiff(2,
                                                  "SCIFIO=1\naxes=X,Y,Z\nlengths=5,4,2\n"
                                                  "scales=1,2,3\nunits=mm,mm,cm\n"));
  test::expect_near(read_volume(file).description().placement.spacing, {1, 2, 30});
}
PELLUCID_DESCRIBED_KEY(shape, tiff_rows, "shape", honored) {
  EXPECT_EQ(
      page_order(read_components(write("a.tif", described_tiff(2, R"({"shape": [2, 4, 5]})")))),
      "0 1");
  expect_refused(
      [&] { read_components(write("a.tif", described_tiff(2, R"({"shape": [3, 4, 5]})"))); },
      "the file has 2 pages");
}
PELLUCID_DESCRIBED_KEY(shape_cut, tiff_rows, "a description that is cut off", told) {
  std::vector<std::string> notes;
  const auto file = write("a.tif", described_tiff(2, R"({"shape": [2, 4, 5], "ax)"));
  noting(file, notes);
  expect_told(notes, "is no JSON (cut off?)");
}
PELLUCID_DESCRIBED_KEY(shape_axes, tiff_rows, "\"axes\"", honored) {
  const auto file = write("a.tif", described_tiff(4, R"({"shape": [2, 2, 4, 5], "axes": "ZCYX"})"));
  EXPECT_EQ(page_order(read_components(file)), "0 2, 1 3");
}
PELLUCID_DESCRIBED_KEY(shape_tags, tiff_rows, "axistags", honored) {
  const auto file =
      write("a.tif", described_tiff(2, R"({"axes": [{"key": "z"}, {"key": "y"}, {"key": "x"}]})"));
  EXPECT_EQ(page_order(read_components(file)), "0 1");
}
PELLUCID_DESCRIBED_KEY(scanimage, tiff_rows, "channelSave", honored) {
  const auto bytes = changed([](TiffPage& page) {
    page.texts[305] =
        "SI.hChannels.channelSave = [1;2]\nSI.hStackManager.enable = true\n"
        "SI.hStackManager.numSlices = 1\n";
  });
  ReadOptions options;
  options.centering = Centering::cell;
  EXPECT_EQ(page_order(read_components(write("a.tif", bytes), options)), "0, 1");
}
PELLUCID_DESCRIBED_KEY(lsm, tiff_rows, "CZ_LSMINFO", honored) {
  const auto bytes = changed([](TiffPage& page) {
    std::string record(128, '\0');
    record[16] = 2;
    const double metres[] = {1e-6, 2e-6, 3e-6};
    std::memcpy(&record[40], metres, sizeof metres);
    page.records[34412] = record;
  });
  const Volume volume = read_volume(write("a.tif", bytes));
  test::expect_near(volume.description().placement.spacing, {1, 2, 3});
}
PELLUCID_DESCRIBED_KEY(micro_manager, tiff_rows, "SliceIndex, ChannelIndex, Axes", honored) {
  test::TiffFile file(false);
  for (int k = 0; k < 2; ++k) {
    TiffPage page = test::counting_page<std::uint16_t>(k, 1);
    page.texts[51123] = "{\"SliceIndex\": " + std::to_string(1 - k) + "}";
    file.add(page);
  }
  EXPECT_EQ(page_order(read_components(write("a.tif", file.bytes()))), "1 0");
}

PELLUCID_DESCRIBED_KEY(png_physical, stack_rows, "pHYs", honored) {
  const auto spacing_by = [&](const std::string& physical) {
    for (int k = 0; k < 2; ++k) {
      write("p" + std::to_string(k) + ".png",
            test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(k), 0, physical));
    }
    return read_volume(folder_).description().placement.spacing;
  };
  // 2000 and 4000 pixels per metre.
  const std::string sizes("\0\0\x07\xd0\0\0\x0f\xa0", 8);
  test::expect_near(spacing_by(sizes + '\1'), {0.5, 0.25, 1});
  test::expect_near(spacing_by(sizes + '\0'), {1, 1, 1});
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  read_volume(folder_, options);
  expect_told(notes, "pHYs without a unit makes pixels 0.5 times as high as wide");
  test::expect_near(spacing_by(std::string("\0\0\x0b\x13\0\0\x0b\x13\1", 9)), {1, 1, 1});
}
using Chunks = std::vector<std::pair<std::string, std::string>>;

/// Two slices with chunks, and what is told of them.
std::vector<Volume> of_png(const std::filesystem::path& folder, const Chunks& chunks,
                           std::vector<std::string>& notes, const std::string& physical = "",
                           int samples = 1) {
  for (int k = 0; k < 2; ++k) {
    std::string values;
    for (const char value : test::page_values<std::uint8_t>(k)) {
      values += std::string(static_cast<std::size_t>(samples), value);
    }
    std::ofstream(folder / ("p" + std::to_string(k) + ".png"), std::ios::binary)
        << test::png(5, 4, 8, samples == 1 ? 0 : 2, values, 0, physical, "", chunks);
  }
  notes.clear();
  return noting(folder, notes);
}

PELLUCID_DESCRIBED_KEY(png_subject, stack_rows, "sCAL", honored) {
  std::vector<std::string> notes;
  const auto spacing_by = [&](const std::string& scale, const std::string& physical = "") {
    return of_png(folder_, {{"sCAL", scale}}, notes, physical)
        .front()
        .description()
        .placement.spacing;
  };
  const std::string metres("\0015e-4\0002.5E-4", 12);
  test::expect_near(spacing_by(metres), {0.5, 0.25, 1});
  expect_told(notes, "the spacing of pixels is the file's, in mm");
  // The size of what is shown goes before that of the print.
  const std::string print("\0\0\x07\xd0\0\0\x0f\xa0\1", 9);
  test::expect_near(spacing_by(metres, print), {0.5, 0.25, 1});
  for (const auto& note : notes) EXPECT_FALSE(contains(note, "pHYs says")) << note;
  const std::string large("\0011\0002", 4);
  test::expect_near(spacing_by(large, print), {1000, 2000, 1});
  expect_told(notes, "pHYs says pixels of 0.5 x 0.25 mm, but sCAL, which is taken, of 1000 x 2000");
  test::expect_near(spacing_by(std::string("\0021\0002", 4)), {1, 1, 1});
  expect_told(notes, "1 x 2 radians");
  for (const std::string& wrong : {std::string("\1"), std::string("\0011\0", 3),
                                   std::string("\001a\0002", 4), std::string("\001-1\0002", 5),
                                   std::string("\0031\0002", 4), std::string("\0010\0001", 4)}) {
    test::expect_near(spacing_by(wrong), {1, 1, 1});
    expect_told(notes, "sCAL is no size of a pixel");
  }
}
PELLUCID_DESCRIBED_KEY(png_calibration, stack_rows, "pCAL", honored) {
  std::vector<std::string> notes;
  const std::string name("depth\0", 6), least(4, '\0'), most("\0\0\0\xff", 4), line("\0\2", 2);
  const std::string of_line("m\000-10\00051", 8);
  const auto value_by = [&](const std::string& calibration, int samples = 1) {
    const auto read = of_png(folder_, {{"pCAL", calibration}}, notes, "", samples);
    return test::value_at(read.front(), 2, 1, 0);
  };
  // -10 + 51 v / 255.
  EXPECT_NEAR(value_by(name + least + most + line + of_line), -10 + 7 * 0.2, 1e-5);
  // 255 stands for the least value, 0 for the largest: 255 - v.
  EXPECT_NEAR(value_by(name + most + least + line + of_line), -10 - 51 * 248 / 255., 1e-5);
  for (const auto& [wrong, why] : std::vector<std::pair<std::string, std::string>>{
           {name + least + most + std::string("\1\3", 2) + "m\0001\0002\0003", "is no line"},
           {name + least + std::string("\0\0\1\0", 4) + line + of_line, "other numbers"},
           {name + least + most + line + std::string("m\0a\0002", 5), "are no numbers"},
           {name + least + most + line, "are no numbers"},
           {name + least, "is damaged"}}) {
    EXPECT_EQ(value_by(wrong), 7);
    expect_told(notes, "pCAL, a calibration of the values, ");
    expect_told(notes, why);
  }
  EXPECT_EQ(value_by(name + least + most + line + of_line, 3), 7);
  expect_told(notes, "is of colors");
  // One file of a stack with it, and one without.
  write("p1.png", test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(1)));
  write("p0.png", test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(0), 0, "", "",
                            {{"pCAL", name + least + most + line + of_line}}));
  expect_refused([&] { read_volume(folder_); }, "another calibration (ImageJ: c0, c1; PNG: pCAL)");
}
PELLUCID_DESCRIBED_KEY(png_transparent, stack_rows, "tRNS", told) {
  for (int k = 0; k < 2; ++k) {
    write("p" + std::to_string(k) + ".png",
          test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(k), 0, "",
                    k == 0 ? std::string("\0\7", 2) : ""));
  }
  std::vector<std::string> notes;
  EXPECT_EQ(test::value_at(noting(folder_, notes).front(), 2, 1, 0), 7);
  expect_told(notes, "tRNS says that a value is transparent");
  expect_told(notes, "differ in tRNS");
}
PELLUCID_DESCRIBED_KEY(names_pattern, stack_rows, "%d, %03d, %+d, %.2f, %g", honored) {
  for (int z = 0; z < 2; ++z) {
    for (int c = 0; c < 2; ++c) {
      write("z" + std::to_string(z) + "_c" + std::to_string(c) + ".tif",
            described_tiff(1, "", {10 * c + z}));
    }
  }
  EXPECT_EQ(page_order(read_components(path("z%d_c1.tif"))), "10 11");
  EXPECT_EQ(page_order(read_components(path("z1_c%d.tif"))), "1 11");
}
PELLUCID_DESCRIBED_KEY(names_series, stack_rows, "several numbers that vary", refused) {
  for (const char* name : {"z0_c0.tif", "z0_c1.tif", "z1_c0.tif", "z1_c1.tif"}) {
    write(name, described_tiff(1, ""));
  }
  expect_refused([&] { read_components(folder_); }, "give the pattern of one");
}
PELLUCID_DESCRIBED_KEY(names_sign, stack_rows, "-1, 0.5", honored) {
  const char* const names[] = {"z-0.5.tif", "z0.0.tif", "z0.5.tif"};
  for (int k = 0; k < 3; ++k) write(names[k], described_tiff(1, "", {k}));
  EXPECT_EQ(page_order(read_components(folder_)), "0 1 2");
}
PELLUCID_DESCRIBED_KEY(names_hidden, stack_rows, "._NAME", honored) {
  for (int k = 0; k < 2; ++k) {
    write("a" + std::to_string(k) + ".tif", described_tiff(1, "", {k}));
    write("._a" + std::to_string(k) + ".tif", "AppleDouble");
  }
  EXPECT_EQ(page_order(read_components(folder_)), "0 1");
}
PELLUCID_DESCRIBED_KEY(names_gap, stack_rows, "a missing number", refused) {
  for (const int k : {1, 2, 4}) write("a" + std::to_string(k) + ".tif", described_tiff(1, ""));
  expect_refused([&] { read_components(folder_); }, "from a2.tif to a4.tif");
}

}  // namespace
}  // namespace pellucid::test_keys_tiff
