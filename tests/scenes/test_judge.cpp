// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "pellucid/reference/render.h"
#include "tests/scenes/reference_frame.h"
#include "tests/scenes/reference_truth.h"
#include "tests/scenes/scene_hash.h"
#include "tests/scenes/tolerance_matrix.h"
#include "tests/support/one_layer.h"

/// The judge of the tolerance, judged.
namespace pellucid::scenes {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Two pixels of which the second is off by 0.25 in blue, and says so.
struct Pair {
  ReferenceFrame reference{2, 1, {{0.5, 0.25, 0, 1}, {0.125, 0, 0.5, 0.75}}};
  Image image;
  Pair() {
    image.width = 2;
    image.height = 1;
    image.pixels = {{0.5F, 0.25F, 0, 1}, {0.125F, 0, 0.75F, 0.75F}};
    image.error = {0, 0.25F};
    image.proved = {1, 0};
  }
};

TEST(Judge, MeasuresAndPlacesTheLargestError) {
  const Pair pair;
  const Verdict verdict = judge(pair.image, pair.reference, 0.25);
  EXPECT_DOUBLE_EQ(verdict.found, 0.25 - reference_accuracy);
  EXPECT_EQ(verdict.worst.column, 1);
  EXPECT_EQ(verdict.worst.row, 0);
  EXPECT_EQ(verdict.worst.channel, 2);
  EXPECT_EQ(verdict.reported, 0.25);
  EXPECT_EQ(verdict.proved, 1);
  EXPECT_EQ(verdict.brightest, 1);
  EXPECT_NEAR(verdict.min_share, 1, 1e-9);
  EXPECT_TRUE(verdict.kept()) << verdict.text();
  EXPECT_EQ(verdict.said_over, 0);
}

TEST(Judge, CountsPixelsOverTheTolerance) {
  const Pair pair;
  const Verdict verdict = judge(pair.image, pair.reference, 0.2499);
  EXPECT_EQ(verdict.over, 1);
  EXPECT_EQ(verdict.over_reported, 0);
  EXPECT_EQ(verdict.said_over, 1);
  EXPECT_FALSE(verdict.kept());
}

TEST(Judge, CountsPixelsOverWhatTheyReport) {
  Pair pair;
  pair.image.error[1] = 0.2499F;
  const Verdict verdict = judge(pair.image, pair.reference, 0.3);
  EXPECT_EQ(verdict.over, 0);
  EXPECT_EQ(verdict.over_reported, 1);
  EXPECT_NEAR(verdict.beyond, 1e-4, 1e-6);
  EXPECT_LT(verdict.min_share, 1);
  EXPECT_FALSE(verdict.kept());
}

/// 48 + 2^-19 lies in the middle between two floats.
TEST(Judge, ForgivesWhatNoFloatCanHoldIfItIsSaid) {
  Pair pair;
  pair.reference.pixels[0][0] = 48 + 0x1p-19;
  pair.image.pixels[0][0] = 48;
  pair.image.error[0] = 2e-6F;
  Verdict verdict = judge(pair.image, pair.reference, 1e-6);
  EXPECT_EQ(verdict.too_bright, 1);
  EXPECT_EQ(verdict.over, 1);  // The second pixel.
  EXPECT_EQ(verdict.over_reported, 0);
  EXPECT_EQ(verdict.said_over, 2);

  pair.image.error[0] = 1e-6F;
  verdict = judge(pair.image, pair.reference, 1e-6);
  EXPECT_EQ(verdict.too_bright, 0);
  EXPECT_EQ(verdict.over, 2);
  EXPECT_EQ(verdict.over_reported, 1);
  EXPECT_NEAR(verdict.beyond, 0x1p-19 - 1e-6, 1e-9);
  EXPECT_EQ(verdict.beyond_at.column, 0);
}

TEST(Judge, LetsNothingPassThatIsNotFinite) {
  for (const float value : {infinity, -infinity, not_a_number}) {
    Pair pair;
    pair.image.pixels[0][3] = value;
    pair.image.error[0] = infinity;
    const Verdict verdict = judge(pair.image, pair.reference, 1);
    EXPECT_EQ(verdict.over, 1) << value;
    EXPECT_EQ(verdict.said_over, 1) << value;
  }
  Pair pair;
  pair.image.error[0] = not_a_number;
  const Verdict verdict = judge(pair.image, pair.reference, 1);
  EXPECT_EQ(verdict.over_reported, 1);
  EXPECT_EQ(verdict.said_over, 1);
  EXPECT_TRUE(std::isinf(verdict.reported));
}

TEST(Judge, RefusesImagesWithoutErrorsAndOfOtherSizes) {
  Pair pair;
  pair.image.proved.clear();
  EXPECT_THROW(judge(pair.image, pair.reference, 1), std::invalid_argument);
  Pair other;
  other.reference.width = 1;
  EXPECT_THROW(judge(other.image, other.reference, 1), std::invalid_argument);
}

Scene small_scene(int samples) {
  Exhibit exhibit;
  exhibit.volume = builtin("marschner_lobb", 17);
  exhibit.transfer_function = transfer({{0, 0.5, {0, 0, 1}}, {1, 2, {1, 0.5, 0}}});
  exhibit.cameras = three_cameras(*exhibit.volume);
  exhibit.samples = samples;
  return scene_of(exhibit, 1, 9);
}

/// The reference has a camera and a rounding of its own.
TEST(ReferenceFrame, RoundsToTheReferenceImage) {
  for (const int samples : {1, 2}) {
    const Scene scene = small_scene(samples);
    const ReferenceFrame frame = reference_frame(scene, 2);
    const Image image = render_reference(scene).image;
    ASSERT_EQ(frame.pixels.size(), image.pixels.size());
    for (std::size_t p = 0; p < frame.pixels.size(); ++p) {
      for (std::size_t c = 0; c < 4; ++c) {
        const double rounded = static_cast<double>(image.pixels[p][c]);
        EXPECT_NEAR(frame.pixels[p][c], rounded, 0x1p-24) << "pixel " << p << ", channel " << c;
      }
    }
  }
}

TEST(ReferenceFrame, IsReadBackAsItWasMade) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "pellucid_reference_frames";
  std::filesystem::remove_all(folder);
  Scene scene = small_scene(1);
  const ReferenceFrame made = cached_reference_frame(scene, 1, folder);
  EXPECT_EQ(cached_reference_frame(scene, 1, folder).pixels, made.pixels);
  const auto files = [&] { return std::distance(std::filesystem::directory_iterator(folder), {}); };
  EXPECT_EQ(files(), 1);
  scene.camera.vertical_angle += 1;
  EXPECT_NE(cached_reference_frame(scene, 1, folder).pixels, made.pixels);
  EXPECT_EQ(files(), 2);
  std::filesystem::remove_all(folder);
}

std::string contents_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class TruthFile : public testing::Test {
 protected:
  TruthFile() {
    truth_.add(scene_, reference_frame(scene_, 1));
    Scene other = scene_;
    other.camera.vertical_angle += 1;
    truth_.add(other, reference_frame(other, 1));
    truth_.write(file_);
  }
  ~TruthFile() override { std::filesystem::remove(file_); }

  std::string error_of(const std::string& contents) const {
    std::ofstream(file_, std::ios::binary) << contents;
    try {
      ReferenceTruth{file_};
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  const Scene scene_ = small_scene(1);
  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("pellucid_truth_") +
       testing::UnitTest::GetInstance()->current_test_info()->name());
  ReferenceTruth truth_;
};

TEST_F(TruthFile, IsReadBackAsItWasWritten) {
  const ReferenceTruth read(file_);
  EXPECT_EQ(read.size(), 2u);
  ASSERT_NE(read.find(scene_), nullptr);
  EXPECT_EQ(read.find(scene_)->pixels, truth_.find(scene_)->pixels);
  EXPECT_EQ(read.find(scene_)->width, 9);
}

TEST_F(TruthFile, HasNothingForAnotherScene) {
  Scene other = scene_;
  test::volume_of(other).transfer_function =
      transfer({{0, 0.5, {0, 0, 1}}, {1, 2, {1, 0.5, 1e-3}}});
  EXPECT_EQ(ReferenceTruth(file_).find(other), nullptr);
  other = scene_;
  other.size.width += 1;
  EXPECT_EQ(ReferenceTruth(file_).find(other), nullptr);
}

TEST_F(TruthFile, IsRefusedWhenItIsDamaged) {
  const std::string whole = contents_of(file_);
  EXPECT_EQ(error_of(whole), "");
  for (std::size_t place = 20; place < whole.size(); place += whole.size() / 50) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    EXPECT_NE(error_of(damaged), "") << place;
    EXPECT_NE(error_of(whole.substr(0, place)), "") << place;
  }
  EXPECT_NE(error_of(whole + std::string(8, '\0')), "");
  EXPECT_NE(error_of(""), "");
  std::filesystem::remove(file_);
  EXPECT_THROW(ReferenceTruth{file_}, std::runtime_error);
}

TEST_F(TruthFile, IsRefusedWhenTheReferenceIsAnother) {
  std::string other = contents_of(file_);
  other[other.find('\n') - 1] = '0';
  EXPECT_NE(error_of(other).find("another version"), std::string::npos);
}

TEST(SceneHash, SeesWhatThePictureDependsOnAndNothingElse) {
  const Scene scene = small_scene(1);
  const auto hash = scene_hash(scene);
  EXPECT_EQ(scene_hash(small_scene(1)), hash);
  EXPECT_NE(scene_hash(small_scene(2)), hash);
  Scene other = scene;
  other.integration.tolerance = 0.5;
  EXPECT_EQ(scene_hash(other), hash);
  other.size.width += 1;
  EXPECT_NE(scene_hash(other), hash);
  other = scene;
  test::volume_of(other).transfer_function =
      transfer({{0, 0.5, {0, 0, 1}}, {1, 2, {1, 0.5, 1e-3}}});
  EXPECT_NE(scene_hash(other), hash);
  other = scene;
  test::volume_of(other).volume = builtin("marschner_lobb", 18);
  EXPECT_NE(scene_hash(other), hash);
}

TEST(SceneHash, SeesEveryChannelAndEveryTerm) {
  GaussianPrimitive gaussian;
  gaussian.channels = {1};
  gaussian.center = {0.5};
  gaussian.matrix = {{10}};
  gaussian.extinction = 1;
  const TransferFunction table({{0, 1, {1, 1, 1}}});
  const auto scene = [&](int points, const GaussianPrimitive& primitive, int channel) {
    Scene result;
    test::channels_of(result).channels = std::make_shared<const Channels>(std::vector<Channel>{
        {"a", "", builtin("marschner_lobb", points)}, {"b", "", builtin("sphere", points)}});
    test::channels_of(result).transfer_function =
        std::make_shared<const MultivariateTransferFunction>(
            2, std::vector<GaussianPrimitive>{primitive},
            std::vector<ChannelTransferFunction>{{channel, table}});
    return scene_hash(result);
  };
  const auto hash = scene(9, gaussian, 0);
  EXPECT_EQ(scene(9, gaussian, 0), hash);
  EXPECT_NE(scene(10, gaussian, 0), hash);
  EXPECT_NE(scene(9, gaussian, 1), hash);
  GaussianPrimitive other = gaussian;
  other.channels = {0};
  EXPECT_NE(scene(9, other, 0), hash);
  other = gaussian;
  other.matrix = {{10}, {1}};
  EXPECT_NE(scene(9, other, 0), hash);
  other = gaussian;
  other.center = {0.25};
  EXPECT_NE(scene(9, other, 0), hash);
  other = gaussian;
  other.color = {0, 0, 1};
  EXPECT_NE(scene(9, other, 0), hash);
}

}  // namespace
}  // namespace pellucid::scenes
