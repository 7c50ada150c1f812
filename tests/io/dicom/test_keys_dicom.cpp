// SPDX-License-Identifier: Apache-2.0
//
// Rows of the table "What descriptions say": DICOM files.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dicom_files.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/described_keys.h"

namespace pellucid::test_keys_dicom {
namespace {

using test::bytes_of;
using test::DicomSliceFile;
using test::expect_near;
using test::value_at;
using test::world_of;

/// Slices of a series, all values of which are their number from 0.
class DicomKeys : public test::DescribedKeys {
 protected:
  void write_slices(const std::function<void(DicomSliceFile&, int)>& change, int count = 3) {
    for (int i = 0; i < count; ++i) {
      DicomSliceFile file;
      file.at("10\\20\\" + std::to_string(30 + 12 * i)).set(0x00200013, std::to_string(i + 1));
      file.pixels = bytes_of(std::vector<std::uint16_t>(20, static_cast<std::uint16_t>(i)));
      change(file, i);
      write("s" + std::to_string(i), file.bytes());
    }
  }
  std::vector<std::string> notes_of(const std::function<void(DicomSliceFile&, int)>& change) {
    write_slices(change);
    std::vector<std::string> notes;
    ReadOptions options;
    options.note = [&](const std::string& text) { notes.push_back(text); };
    read_volume(folder_, options);
    return notes;
  }
  void expect_refusal(const std::function<void(DicomSliceFile&, int)>& change,
                      const std::string& key) {
    write_slices(change);
    expect_refused([&] { read_volume(folder_); }, key);
  }
  /// Six slices, two at each place; expects two series that name the key.
  void expect_series(const std::function<void(DicomSliceFile&, int)>& change,
                     const std::string& key) {
    write_slices(
        [&](DicomSliceFile& file, int i) {
          file.at("10\\20\\" + std::to_string(30 + 12 * (i / 2)));
          change(file, i % 2);
        },
        6);
    const std::vector<DicomSeries> list = list_dicom_series(folder_);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_TRUE(test::contains(list[1].description, key)) << list[1].description;
    ReadOptions options;
    options.series = "2";
    EXPECT_EQ(value_at(read_volume(folder_, options), 0, 0, 2), 5);
  }
};

// As PELLUCID_DESCRIBED_KEY, with tests of the class above.
#define DICOM_ROW(name, key, treatment)                                \
  [[maybe_unused]] static const bool described_dicom_##name = [] {     \
    ::pellucid::test::described_keys().push_back(                      \
        {"DICOM files", key, ::pellucid::test::Treatment::treatment}); \
    return true;                                                       \
  }();                                                                 \
  class DescribedKeys_dicom_##name : public DicomKeys {};              \
  TEST_F(DescribedKeys_dicom_##name, Read)

DICOM_ROW(position, "ImagePositionPatient", honored) {
  write_slices([](auto&, int) {});
  expect_near(world_of(read_volume(folder_), 0, 0, 2), {10, 20, 54});
}
DICOM_ROW(orientation, "ImageOrientationPatient", honored) {
  write_slices([](auto& f, int) { f.set(0x00200037, "-1\\0\\0\\0\\-1\\0"); });
  expect_near(world_of(read_volume(folder_), 1, 1, 0), {9, 18, 30});
}
DICOM_ROW(spacing, "PixelSpacing", honored) {
  write_slices([](auto& f, int) { f.set(0x00280030, "3\\4"); });
  expect_near(world_of(read_volume(folder_), 1, 1, 0), {14, 23, 30});
}
DICOM_ROW(location, "SliceLocation", honored) {
  write_slices(
      [](auto& f, int i) { f.without(0x00200032).set(0x00201041, std::to_string(7 * i)); });
  expect_near(world_of(read_volume(folder_), 0, 0, 2), {0, 0, 14});
}
DICOM_ROW(between, "SpacingBetweenSlices", honored) {
  write_slices([](auto& f, int) { f.without(0x00200032).set(0x00180088, "3"); });
  expect_near(world_of(read_volume(folder_), 0, 0, 2), {0, 0, 6});
}
DICOM_ROW(slope, "RescaleSlope", honored) {
  write_slices([](auto& f, int) { f.set(0x00281053, "2").set(0x00281052, "1"); });
  EXPECT_EQ(value_at(read_volume(folder_), 0, 0, 2), 5);
}
DICOM_ROW(dose, "DoseGridScaling", honored) {
  write_slices([](auto& f, int) {
    f.text[0x00080060] = {"CS", "RTDOSE"};
    f.text[0x3004000e] = {"DS", "0.5"};
  });
  EXPECT_EQ(value_at(read_volume(folder_), 0, 0, 2), 1);
}
DICOM_ROW(lookup, "ModalityLUTSequence", refused) {
  expect_refusal([](auto& f, int) { f.sequences[0x00283000] = {""}; }, "ModalityLUTSequence");
}
DICOM_ROW(monochrome, "PhotometricInterpretation", told) {
  expect_told(notes_of([](auto& f, int) { f.set(0x00280004, "MONOCHROME1"); }), "MONOCHROME1");
  for (const int odd : {0, 1, 2}) {
    const auto one = notes_of([&](auto& f, int i) {
      if (i == odd) f.set(0x00280004, "MONOCHROME1");
    });
    expect_told(one, "in 1 of 3 slices (MONOCHROME1)");
  }
  expect_refusal([](auto& f, int) { f.set(0x00280004, "PALETTE COLOR"); }, "palette");
}
DICOM_ROW(shape, "PresentationLUTShape", told) {
  expect_told(notes_of([](auto& f, int) {
                f.text[0x20500020] = {"CS", "INVERSE"};
              }),
              "PresentationLUTShape");
  EXPECT_TRUE(notes_of([](auto& f, int) { f.text[0x20500020] = {"CS", "IDENTITY"}; }).empty());
}
DICOM_ROW(padding, "PixelPaddingValue", told) {
  expect_told(notes_of([](auto& f, int) { f.set(0x00280120, 63536); }),
              "stored values 63536 (PixelPaddingValue)");
  expect_told(notes_of([](auto& f, int) { f.set(0x00280120, 63536).set(0x00280103, 1); }),
              "stored values -2000 (PixelPaddingValue)");
}
DICOM_ROW(padding_limit, "PixelPaddingRangeLimit", told) {
  expect_told(notes_of([](auto& f, int) { f.set(0x00280120, 0).set(0x00280121, 7); }),
              "0 to 7 (PixelPaddingValue, PixelPaddingRangeLimit)");
}
DICOM_ROW(mapping, "RealWorldValueMappingSequence", told) {
  const auto mapping = [](double slope, double intercept) {
    return [=](DicomSliceFile& f, int) {
      const test::DicomWriter w = f.writer();
      f.sequences[0x00409096] = {
          w.element(0x00409224, "FD", bytes_of(std::vector<double>{intercept})) +
          w.element(0x00409225, "FD", bytes_of(std::vector<double>{slope}))};
      f.set(0x00281053, "2").set(0x00281052, "1");
    };
  };
  const std::vector<std::string> notes = notes_of(mapping(0.001, 7));
  expect_told(notes, "RealWorldValueMappingSequence");
  expect_told(notes, "slope 0.001, intercept 7");
  EXPECT_TRUE(notes_of(mapping(2, 1)).empty());
}
DICOM_ROW(palette, "RedPaletteColorLookupTableDescriptor", told) {
  expect_told(notes_of([](auto& f, int) {
                f.text[0x00281101] = {"US", f.writer().number(256, 2) + f.writer().number(0, 2) +
                                                f.writer().number(16, 2)};
              }),
              "RedPaletteColorLookupTableDescriptor");
}
DICOM_ROW(overlay, "OverlayData", told) {
  expect_told(notes_of([](auto& f, int) { f.set(0x60000010, 4); }), "OverlayData");
}
DICOM_ROW(relationship, "PixelIntensityRelationship", told) {
  expect_told(notes_of([](auto& f, int) {
                f.text[0x00281040] = {"CS", "LOG"};
              }),
              "PixelIntensityRelationship");
}
DICOM_ROW(aspect, "PixelAspectRatio", told) {
  expect_told(notes_of([](auto& f, int) {
                f.without(0x00280030);
                f.text[0x00280034] = {"IS", "2\\1"};
              }),
              "PixelAspectRatio");
}
DICOM_ROW(acquisition, "AcquisitionNumber", honored) {
  expect_series([](auto& f, int k) { f.set(0x00200012, std::to_string(k)); }, "AcquisitionNumber");
}
DICOM_ROW(echo, "EchoNumbers", honored) {
  expect_series([](auto& f, int k) { f.set(0x00180086, std::to_string(k)); }, "EchoNumbers");
}
DICOM_ROW(echo_time, "EchoTime", honored) {
  expect_series([](auto& f, int k) { f.set(0x00180081, std::to_string(k)); }, "EchoTime");
}
DICOM_ROW(inversion_time, "InversionTime", honored) {
  expect_series([](auto& f, int k) { f.set(0x00180082, std::to_string(k)); }, "InversionTime");
}
DICOM_ROW(trigger_time, "TriggerTime", honored) {
  expect_series([](auto& f, int k) { f.set(0x00181060, std::to_string(k)); }, "TriggerTime");
}
DICOM_ROW(temporal, "TemporalPositionIdentifier", honored) {
  expect_series([](auto& f, int k) { f.set(0x00200100, std::to_string(k)); }, "TemporalPosition");
}
DICOM_ROW(b_value, "DiffusionBValue", honored) {
  expect_series(
      [](auto& f, int k) {
        f.text[0x00189087] = {"FD", bytes_of(std::vector<double>{1000. * k})};
      },
      "DiffusionBValue 1000");
}
DICOM_ROW(gradient, "DiffusionGradientOrientation", honored) {
  expect_series(
      [](auto& f, int k) {
        f.text[0x00189089] = {"FD", bytes_of(std::vector<double>{1. * k, 1. - k, 0})};
      },
      "DiffusionGradientOrientation");
}
DICOM_ROW(image_type, "ImageType", honored) {
  expect_series(
      [](auto& f, int k) {
        f.text[0x00080008] = {"CS", k == 0 ? "ORIGINAL\\PRIMARY\\M" : "ORIGINAL\\PRIMARY\\P"};
      },
      "ImageType");
}
DICOM_ROW(kernel, "ConvolutionKernel", honored) {
  expect_series(
      [](auto& f, int k) {
        f.text[0x00181210] = {"SH", k == 0 ? "B30" : "B70"};
      },
      "ConvolutionKernel");
}
DICOM_ROW(instance, "InstanceNumber", honored) {
  expect_series([](auto&, int) {}, "InstanceNumber");
}

}  // namespace
}  // namespace pellucid::test_keys_dicom
