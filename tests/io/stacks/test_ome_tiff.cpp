// SPDX-License-Identifier: Apache-2.0

// Order and number of pages by OME-XML; the expected orders follow the OME-TIFF specification.

#include <filesystem>
#include <string>
#include <vector>

#include "tests/io/noting_folder.h"

namespace pellucid::test_ome_tiff {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::described_tiff;
using test::error_of;
using test::ome_xml;

class OmeTiffTest : public test::NotingFolder {
 protected:
  fs::path ome(int pages, const std::string& description, const std::string& name = "o.ome.tif") {
    return write(name, described_tiff(pages, description));
  }
};

TEST_F(OmeTiffTest, PlanesAreInTheOrderOfTiffData) {
  std::string reversed;
  for (int i = 0; i < 6; ++i) {
    reversed += "<TiffData FirstZ=\"" + std::to_string(5 - i) + "\" IFD=\"" + std::to_string(i) +
                "\" PlaneCount=\"1\"/>";
  }
  EXPECT_EQ(order(ome(6, ome_xml({6, 1, 1}, reversed))), "5 4 3 2 1 0");
  // IFD alone means one plane, neither of them all pages.
  EXPECT_EQ(order(ome(2, ome_xml({2, 1, 1},
                                 "<TiffData IFD=\"1\"/><TiffData FirstZ=\"1\" "
                                 "IFD=\"0\"/>"))),
            "1 0");
  EXPECT_EQ(order(ome(6, ome_xml({6, 1, 1}, "<TiffData/>"))), "0 1 2 3 4 5");
  EXPECT_EQ(order(ome(6, ome_xml({6, 1, 1}, ""))), "0 1 2 3 4 5");
  EXPECT_EQ(order(ome(4, ome_xml({4, 1, 1},
                                 "<TiffData IFD=\"2\" PlaneCount=\"2\"/><TiffData "
                                 "FirstZ=\"2\" IFD=\"0\" PlaneCount=\"2\"/>"))),
            "2 3 0 1");
  // Prefixes of names, single quotes and a ">" in a value are XML.
  std::string prefixed = ome_xml({3, 1, 1},
                                 "<o:TiffData IFD='2'/><o:TiffData FirstZ='1' IFD='0'/>"
                                 "<o:TiffData FirstZ='2' IFD='1'/>");
  for (const char* name : {"OME ", "Image ", "Pixels ", "/Pixels", "/Image", "/OME"}) {
    const std::string text = std::string("<") + name;
    const std::string with = text[1] == '/' ? "</o:" + text.substr(2) : "<o:" + text.substr(1);
    prefixed.replace(prefixed.find(text), text.size(), with);
  }
  prefixed.replace(prefixed.find("first"), 5, "a>b");
  EXPECT_EQ(order(ome(3, prefixed)), "2 0 1");
}

TEST_F(OmeTiffTest, DimensionOrderNamesChannelsAndTimes) {
  const std::array<int, 3> sizes{3, 2, 2};
  const auto with = [&](const std::string& dimensions) {
    return order(ome(12, ome_xml(sizes, "<TiffData/>", "", dimensions)));
  };
  // Components are channels, then times.
  EXPECT_EQ(with("XYZCT"), "0 1 2, 3 4 5, 6 7 8, 9 10 11");
  EXPECT_EQ(with("XYCZT"), "0 2 4, 1 3 5, 6 8 10, 7 9 11");
  EXPECT_EQ(with("XYTZC"), "0 2 4, 6 8 10, 1 3 5, 7 9 11");
  EXPECT_EQ(with("XYTCZ"), "0 4 8, 2 6 10, 1 5 9, 3 7 11");
  EXPECT_TRUE(contains(refused(ome(12, ome_xml(sizes, "", "", "XYZ"))), "no order of axes"));
  EXPECT_TRUE(contains(refused(ome(12, ome_xml(sizes, "", "", "ZXYCT"))), "no order of axes"));
  // A run goes on over the axes from where it begins.
  EXPECT_EQ(order(ome(4, ome_xml({2, 2, 1},
                                 "<TiffData IFD=\"3\" FirstC=\"0\"/><TiffData "
                                 "FirstZ=\"1\" IFD=\"0\" PlaneCount=\"3\"/>"))),
            "3 0, 1 2");
}

TEST_F(OmeTiffTest, ChannelsHaveNamesAndTimesAreChosen) {
  const std::string inside =
      "<Channel ID=\"c0\" Name=\"DAPI\"/><Channel ID=\"c1\" Name=\"GFP &amp; co\"/><TiffData/>";
  const fs::path file = ome(4, ome_xml({2, 2, 1}, inside));
  EXPECT_TRUE(contains(error_of([&] { read_volume(file); }), "2 channels (DAPI, GFP & co)"));
  ReadOptions options;
  options.component_name = "GFP & co";
  EXPECT_EQ(order(file, options), "2 3");
  options.component_name = "RFP";
  EXPECT_TRUE(contains(refused(file, options), "their names are DAPI, GFP & co"));
  options = {};
  options.time = 1;
  EXPECT_TRUE(contains(refused(file, options), "no steps in time"));

  const fs::path times = ome(12, ome_xml({2, 2, 3}, inside, "TimeIncrement=\"2.5\""));
  EXPECT_EQ(order(times), "0 1, 2 3, 4 5, 6 7, 8 9, 10 11");
  EXPECT_TRUE(is_noted("3 times of 2 channels (DAPI, GFP & co), which are its components"))
      << notes();
  options.time = 2.4;  // the step at 2.5
  EXPECT_EQ(order(times, options), "4 5, 6 7");
  options.component_name = "GFP & co";
  EXPECT_EQ(order(times, options), "6 7");
  options.time = 1e9;
  EXPECT_EQ(order(times, options), "10 11");
}

TEST_F(OmeTiffTest, MissingPlanesAreRefused) {
  EXPECT_TRUE(contains(refused(ome(4, ome_xml({6, 1, 1}, "<TiffData/>"))), "says 6 slices"));
  EXPECT_TRUE(contains(refused(ome(4, ome_xml({6, 1, 1}, ""))), "the file has 4 pages"));
  EXPECT_TRUE(contains(refused(ome(3, ome_xml({6, 1, 1},
                                              "<TiffData IFD=\"0\" "
                                              "PlaneCount=\"6\"/>"))),
                       "names page 5 (from 0) of o.ome.tif, which has 3 pages"));
  EXPECT_TRUE(
      contains(refused(ome(2, ome_xml({2, 1, 1}, "<TiffData IFD=\"0\"/>"))), "only 1 of 2 planes"));
  EXPECT_TRUE(contains(refused(ome(8, ome_xml({6, 1, 1}, "<TiffData/>"))), "the file has 8 pages"));
  EXPECT_TRUE(contains(refused(ome(2, ome_xml({2, 1, 1},
                                              "<TiffData IFD=\"0\"/><TiffData "
                                              "IFD=\"1\"/>"))),
                       "two pages for one plane"));
  EXPECT_TRUE(contains(refused(ome(2, ome_xml({2, 1, 1},
                                              "<TiffData IFD=\"1\"/><TiffData "
                                              "FirstZ=\"1\" IFD=\"1\"/>"))),
                       "two planes for one page"));
  EXPECT_TRUE(contains(refused(ome(2, ome_xml({2, 1, 1}, "<TiffData FirstZ=\"7\"/>"))), "z = 7"));
  EXPECT_TRUE(contains(
      refused(ome(2, ome_xml({2, 1, 1}, "<TiffData IFD=\"0\" FirstZ=\"1\" PlaneCount=\"2\"/>"))),
      "more planes than that"));
  EXPECT_TRUE(
      contains(refused(ome(2, ome_xml({2, 1, 1}, "<TiffData IFD=\"-1\"/>"))), "IFD=\"-1\""));
  EXPECT_TRUE(contains(refused(ome(2, ome_xml({2000000000, 2000000000, 2000000000}, ""))),
                       "mend the description"));
  EXPECT_TRUE(contains(refused(ome(2, "<OME><Image></Image></OME>")), "describes no image"));
  EXPECT_FALSE(refused(ome(2, "<OME><Image><Pixels SizeZ=\"2\"")).empty());
}

// A killed acquisition has no pages for its last steps.
TEST_F(OmeTiffTest, TimesThatAreNotWholeAreLeftOut) {
  std::string listed;
  for (int i = 0; i < 5; ++i) {
    listed += "<TiffData IFD=\"" + std::to_string(i) + "\" FirstZ=\"" + std::to_string(i % 2) +
              "\" FirstT=\"" + std::to_string(i / 2) + "\" PlaneCount=\"1\"/>";
  }
  EXPECT_EQ(order(ome(5, ome_xml({2, 1, 9}, listed))), "0 1, 2 3");
  EXPECT_TRUE(is_noted("9 times, of which 2 are whole")) << notes();
}

TEST_F(OmeTiffTest, PagesOfNoPlaneAreTold) {
  EXPECT_EQ(order(ome(3, ome_xml({2, 1, 1}, "<TiffData IFD=\"1\" PlaneCount=\"2\"/>"))), "1 2");
  EXPECT_TRUE(is_noted("1 page of the file stands for no plane")) << notes();
}

// Directories that are thumbnails count as directories.
TEST_F(OmeTiffTest, IfdCountsThumbnails) {
  test::TiffFile file(false);
  for (int k = 0; k < 4; ++k) {
    test::TiffPage page = test::counting_page<std::uint16_t>(k, 1);
    if (k == 0) {
      page.description = ome_xml({2, 1, 1},
                                 "<TiffData IFD=\"3\"/><TiffData FirstZ=\"1\" "
                                 "IFD=\"2\"/>");
    }
    if (k == 1) page.fields[254] = {1};
    file.add(page);
  }
  EXPECT_EQ(order(write("t.ome.tif", file.bytes())), "3 2");
}

TEST_F(OmeTiffTest, FilesThatBelongTogether) {
  const auto data = [](int z, const std::string& file, int directory = 0) {
    return "<TiffData FirstZ=\"" + std::to_string(z) + "\" IFD=\"" + std::to_string(directory) +
           "\" PlaneCount=\"1\"><UUID FileName=\"" + file + "\">urn:uuid:" + file +
           "</UUID></TiffData>";
  };
  // b has the first slice, a the others, in turn.
  const std::string xml =
      ome_xml({3, 1, 1}, data(0, "b.ome.tif") + data(1, "a.ome.tif", 1) + data(2, "a.ome.tif", 0));
  write("a.ome.tif", described_tiff(2, xml, {4, 5}));
  write("b.ome.tif", described_tiff(1, xml, {7}));
  EXPECT_EQ(order(path("a.ome.tif")), "7 5 4");
  EXPECT_EQ(order(path("b.ome.tif")), "7 5 4");
  EXPECT_EQ(order(folder_), "7 5 4");
  fs::remove(path("b.ome.tif"));
  EXPECT_TRUE(contains(refused(path("a.ome.tif")), "in b.ome.tif, which is not beside it"));
  write("b.ome.tif", test::tiff(test::counting_page<std::uint8_t>(1, 1)));
  EXPECT_TRUE(contains(refused(path("a.ome.tif")), "b.ome.tif is 5 x 4 of u8"));
  const std::string out = ome_xml({2, 1, 1}, data(0, "c.ome.tif") + data(1, "../b.ome.tif"));
  EXPECT_TRUE(contains(refused(ome(1, out, "c.ome.tif")), "leaves the folder"));
  // A file of a set of one that has another name now.
  const std::string one = ome_xml({2, 1, 1}, data(1, "old.ome.tif") + data(0, "old.ome.tif", 1));
  EXPECT_EQ(order(ome(2, one, "new.ome.tif")), "1 0");
  // By its UUID, whatever the names.
  const std::string own =
      ome_xml({1, 2, 1},
              "<TiffData IFD=\"0\" FirstC=\"1\"><UUID FileName=\"x\">urn:uuid:own</UUID>"
              "</TiffData><TiffData IFD=\"1\"><UUID FileName=\"y\"> urn:uuid:own </UUID>"
              "</TiffData>");
  ReadOptions cells;
  cells.centering = Centering::cell;
  EXPECT_EQ(order(ome(2, own, "own.ome.tif"), cells), "1, 0");
}

TEST_F(OmeTiffTest, DescriptionInACompanion) {
  const std::string only =
      "<OME><BinaryOnly MetadataFile=\"set.companion.ome\" UUID=\"urn:uuid:m\"/></OME>";
  const fs::path file = ome(2, only, "a.ome.tif");
  EXPECT_TRUE(contains(refused(file), "described in set.companion.ome, which is not beside it"));
  write("set.companion.ome",
        ome_xml({2, 1, 1},
                "<TiffData IFD=\"0\" FirstZ=\"1\"><UUID FileName=\"a.ome.tif\">urn:uuid:a</UUID>"
                "</TiffData><TiffData IFD=\"1\"><UUID FileName=\"a.ome.tif\">urn:uuid:a</UUID>"
                "</TiffData>",
                "PhysicalSizeX=\"2\" PhysicalSizeY=\"3\" PhysicalSizeZ=\"4\""));
  EXPECT_EQ(order(file), "1 0");
  test::expect_near(spacing(file), {2, 3, 4});
  // By its own name, and in a folder of no other files.
  EXPECT_EQ(order(path("set.companion.ome")), "1 0");
  EXPECT_EQ(order(folder_), "1 0");
  EXPECT_FALSE(is_noted("no image")) << notes();
  fs::rename(file, path("b.ome.tif"));
  EXPECT_TRUE(contains(refused(path("set.companion.ome")), "a.ome.tif, which is not beside it"));
  write("a.ome.tif", test::described_tiff(2, ""));
  EXPECT_TRUE(contains(refused(path("set.companion.ome")), "which has no OME-XML"));
  write("set.companion.ome", ome_xml({2, 1, 1}, "<TiffData IFD=\"0\"/>"));
  EXPECT_TRUE(contains(refused(path("set.companion.ome")), "names no file of pages"));
}

TEST_F(OmeTiffTest, DescriptionInAnotherTiff) {
  const std::string only = "<OME><BinaryOnly MetadataFile=\"m.ome.tif\" UUID=\"urn:b\"/></OME>";
  const fs::path file = ome(1, only, "b.ome.tif");
  EXPECT_TRUE(contains(refused(file), "described in m.ome.tif, which is not beside it"));
  const std::string xml =
      ome_xml({2, 1, 1},
              "<TiffData IFD=\"0\"><UUID FileName=\"b.ome.tif\">urn:b</UUID></TiffData>"
              "<TiffData IFD=\"0\" FirstZ=\"1\"><UUID FileName=\"m.ome.tif\">urn:uuid:own</UUID>"
              "</TiffData>",
              "PhysicalSizeX=\"2\" PhysicalSizeY=\"3\" PhysicalSizeZ=\"4\"");
  write("m.ome.tif", test::described_tiff(1, xml, {7}));
  for (const char* name : {"b.ome.tif", "m.ome.tif"}) {
    EXPECT_EQ(order(path(name)), "0 7") << name;
    test::expect_near(spacing(path(name)), {2, 3, 4});
  }
  write("m.ome.tif", test::described_tiff(1, ""));
  EXPECT_TRUE(contains(refused(file), "m.ome.tif: has no OME-XML"));
  write("m.ome.tif", test::described_tiff(1, only));
  EXPECT_TRUE(contains(refused(file), "describes no image"));
}

TEST_F(OmeTiffTest, AxesThatAreDividedFurther) {
  const std::string divided =
      "<StructuredAnnotations><XMLAnnotation><Value><m:Modulo><m:ModuloAlongT Type=\"lifetime\"/>"
      "</m:Modulo></Value></XMLAnnotation></StructuredAnnotations>";
  const auto with = [&](const std::string& more) {
    std::string xml = ome_xml({2, 1, 1}, "<TiffData/>");
    xml.insert(xml.rfind("</OME>"), more);
    return xml;
  };
  order(ome(2, with(divided)));
  EXPECT_TRUE(is_noted("divides an axis further (ModuloAlongT)")) << notes();
  // Words are no element.
  for (const char* words : {"<!-- ModuloAlongT -->", "<Notes>no ModuloAlongZ</Notes>"}) {
    order(ome(2, with(words)));
    EXPECT_FALSE(is_noted("divides")) << notes();
  }
  // The document may be another file.
  write("set.companion.ome", with(divided));
  order(ome(2, "<OME><BinaryOnly MetadataFile=\"set.companion.ome\" UUID=\"m\"/></OME>"));
  EXPECT_TRUE(is_noted("ModuloAlongT")) << notes();
}

TEST_F(OmeTiffTest, SeveralImages) {
  const auto image = [](const std::string& name, const std::string& data) {
    return "<Image Name=\"" + name +
           "\"><Pixels DimensionOrder=\"XYZCT\" SizeX=\"5\" SizeY=\"4\" SizeZ=\"2\" SizeC=\"1\" "
           "SizeT=\"1\">" +
           data + "</Pixels></Image>";
  };
  const fs::path file =
      ome(4, "<OME>" + image("one", "<TiffData IFD=\"0\" PlaneCount=\"2\"/>") +
                 image("two", "<TiffData IFD=\"2\" PlaneCount=\"2\"/>") + "</OME>");
  EXPECT_EQ(order(file), "0 1");
  EXPECT_TRUE(is_noted("describes 2 images (1: one, 2: two); the first is read")) << notes();
  ReadOptions options;
  for (const char* series : {"2", "two"}) {
    options.series = series;
    EXPECT_EQ(order(file, options), "2 3");
    EXPECT_FALSE(is_noted("describes 2 images"));
  }
  options.series = "three";
  EXPECT_TRUE(contains(refused(file, options), "none of its images is meant"));
  const fs::path plain = ome(2, "", "plain.tif");
  EXPECT_TRUE(contains(refused(plain, options), "no OME-XML"));
  EXPECT_TRUE(contains(refused(ome(4, "<OME>" + image("one", "") + image("two", "") + "</OME>")),
                       "does not say which pages are whose"));
}

// Channels of several samples each count by samples.
TEST_F(OmeTiffTest, SamplesAreOfChannels) {
  const auto colors = [&](const std::string& description) {
    test::TiffFile file(false);
    for (int k = 0; k < 2; ++k) {
      test::TiffPage page;
      page.fields[258] = {8, 8, 8};
      page.fields[262] = {2};
      page.fields[277] = {3};
      page.strips = {std::string(60, static_cast<char>(k + 1))};
      if (k == 0) page.description = description;
      file.add(page);
    }
    return write("rgb.ome.tif", file.bytes());
  };
  EXPECT_EQ(components(colors(ome_xml({2, 3, 1}, "<TiffData/>"))).size(), 3u);
  ReadOptions cells;
  cells.centering = Centering::cell;
  const std::vector<Volume> both = components(
      colors(ome_xml({1, 6, 1}, "<TiffData IFD=\"1\"/><TiffData FirstC=\"3\" IFD=\"0\"/>")), cells);
  ASSERT_EQ(both.size(), 6u);
  EXPECT_EQ(test::value_at(both[0], 0, 0, 0), 2);
  EXPECT_EQ(test::value_at(both[5], 0, 0, 0), 1);
  EXPECT_TRUE(contains(refused(colors(ome_xml({1, 4, 1}, ""))), "4 channels (SizeC)"));
}

TEST_F(OmeTiffTest, PlanesOfAnotherSizeAreTold) {
  std::string xml = ome_xml({2, 1, 1}, "<TiffData/>");
  xml.replace(xml.find("SizeX=\"5\""), 9, "SizeX=\"9\"");
  components(ome(2, xml));
  EXPECT_TRUE(is_noted("says planes of 9 x 4, but its pages are 5 x 4")) << notes();
}

TEST_F(OmeTiffTest, DistancesHaveTheirOwnUnits) {
  const auto with = [&](const std::string& attributes, const std::string& inside = "<TiffData/>") {
    return spacing(ome(2, ome_xml({2, 1, 1}, inside, attributes)));
  };
  const std::string xy = "PhysicalSizeX=\"0.3\" PhysicalSizeY=\"0.3\" ";
  test::expect_near(with(xy + "PhysicalSizeZ=\"1e-5\" PhysicalSizeZUnit=\"dm\""), {0.3, 0.3, 1});
  EXPECT_TRUE(is_noted("turned into \u00b5m")) << notes();
  test::expect_near(with(xy + "PhysicalSizeZ=\"1000\" PhysicalSizeZUnit=\"nm\""), {0.3, 0.3, 1});
  test::expect_near(
      with("PhysicalSizeX=\"1\" PhysicalSizeXUnit=\"in\" PhysicalSizeY=\"0.5\" "
           "PhysicalSizeYUnit=\"ft\" PhysicalSizeZ=\"25.4\" PhysicalSizeZUnit=\"mm\""),
      {1, 6, 1});
  test::expect_near(with(xy + "PhysicalSizeZ=\"5\" PhysicalSizeZUnit=\"\u00c5\""), {0.3, 0.3, 5e-4},
                    1e-9);
  test::expect_near(with(xy + "PhysicalSizeZ=\"5\" PhysicalSizeZUnit=\"reference frame\""),
                    {0.3, 0.3, 5});
  EXPECT_TRUE(is_noted("reference frame, which cannot be turned into one")) << notes();
  test::expect_near(with("PhysicalSizeX=\"2\" PhysicalSizeZ=\"4\""), {2, 2, 4});
  EXPECT_TRUE(is_noted("no PhysicalSizeY")) << notes();
  test::expect_near(with("PhysicalSizeZ=\"4\""), {1, 1, 4});
  test::expect_near(with(xy + "PhysicalSizeZ=\"0\""), {0.3, 0.3, 1});
  EXPECT_TRUE(is_noted("which is no distance")) << notes();
  test::expect_near(with("PhysicalSizeX=\"2\" PhysicalSizeXUnit=\"&#181;m\" PhysicalSizeY=\"3000\" "
                         "PhysicalSizeYUnit=\"nm\""),
                    {2, 3, 1});
  const auto planes = [](const char* first, const char* second) {
    return std::string("<TiffData/><Plane TheZ=\"0\" TheC=\"0\" TheT=\"0\" PositionZ=\"") + first +
           "\" PositionZUnit=\"mm\"/><Plane TheZ=\"1\" TheC=\"0\" TheT=\"0\" PositionZ=\"" +
           second + "\" PositionZUnit=\"mm\"/>";
  };
  test::expect_near(with(xy, planes("0.5", "0.502")), {0.3, 0.3, 2});
  test::expect_near(with(xy + "PhysicalSizeZ=\"2\"", planes("0.502", "0.5")), {0.3, 0.3, 2});
  EXPECT_TRUE(is_noted("PositionZ go down with z")) << notes();
  test::expect_near(with(xy + "PhysicalSizeZ=\"2\"", planes("0", "3")), {0.3, 0.3, 2});
  EXPECT_TRUE(is_noted("another distance than PhysicalSizeZ")) << notes();
}

}  // namespace
}  // namespace pellucid::test_ome_tiff
