// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/io/film_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/io/internal/temporary_folder.h"
#include "pellucid/scene/error.h"
#include "view/command.h"
#include "view/film/film_job.h"
#include "view/film/keyframes.h"
#include "view/scene_facts.h"
#include "view/scene_state.h"
#include "view/view_input.h"

namespace pellucid::view::film_test {
namespace {

namespace fs = std::filesystem;

/// A .vti of 4 x 4 x 4 points at three times, with the values 0 to 1, 1 to 2, 2 to 3.
fs::path file_with_steps(const std::string& times = "0 0.5 2") {
  static const TemporaryFolder folder("steps of a test");
  std::string arrays;
  for (int step = 0; step < 3; ++step) {
    arrays += R"(<DataArray type="Float32" Name="a" format="ascii" TimeStep=")" +
              std::to_string(step) + "\">";
    for (int i = 0; i < 64; ++i) arrays += std::to_string(step + i / 63.0) + " ";
    arrays += "</DataArray>";
  }
  const fs::path path = folder.path() / (times + ".vti");
  write_text_file(path, R"(<VTKFile type="ImageData"><ImageData WholeExtent="0 3 0 3 0 3" )"
                        R"(Origin="0 0 0" Spacing="1 1 1" TimeValues=")" +
                            times +
                            "\">"
                            R"(<Piece Extent="0 3 0 3 0 3"><PointData Scalars="a">)" +
                            arrays + "</PointData></Piece></ImageData></VTKFile>");
  return path;
}

SceneState state_of(const std::string& layers, const std::string& more = "") {
  SceneDescription description = parse_scene(
      R"({"layers": [)" + layers + R"(], "image": {"width": 24, "height": 16})" + more + "}",
      "test");
  Scene scene = make_scene(description);
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    complete_description(scene.layers[i], description.layers[i]);
  }
  description.camera = scene.camera;
  return {std::move(description), std::move(scene), {}};
}

SceneState shells() {
  return state_of(R"({"field": {"builtin": "shells", "points": 16},
                      "isosurfaces": [{"value": 0.5}], "shading": {}})");
}

SceneState steps(const std::string& more = "") {
  return state_of(R"({"field": {"file": ")" + file_with_steps().string() + R"("},
      "transfer_function": {"points": [{"value": 0, "extinction": 0.1, "color": [1, 0, 0]},
                                       {"value": 3, "extinction": 2, "color": [0, 1, 0]}]}})",
                  more);
}

using Pixels = std::vector<std::array<float, 4>>;

Pixels pixels_of(const Scene& scene) {
  return render(scene).image.pixels;
}

/// Pixels of a frame as the film of the saved scene has them.
Pixels film_pixels(const SceneState& state, int frame) {
  SceneDescription saved = parse_scene(state.saved(), "saved");
  const Animation animation = *saved.animation;
  if (animation.moves_data()) saved.time.reset();
  resolve_time(saved);
  const SceneTimes times(saved);
  SceneDescription base = saved;
  base.animation.reset();
  return pixels_of(make_scene(Film(base, base, animation, times).description(frame)));
}

Camera from(double x, double y, double z) {
  Camera camera;
  camera.position = {x, y, z};
  camera.focal_point = {0, 0, 0};
  camera.up = {0, 1, 0};
  return camera;
}

template <class Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void expect_error(const std::string& error, const std::string& part) {
  EXPECT_NE(error.find(part), error.npos) << error;
}

TEST(Time, IsTakenFromTheSources) {
  SceneState state = steps(R"(, "time": 0.6)");
  EXPECT_EQ(state.times(), (std::vector<double>{0, 0.5, 2}));
  EXPECT_EQ(state.time(), 0.6);
  SceneDescription resolved = state.description();
  resolved.time.reset();
  resolved.layers[0].field.options.time = 0.5;
  const SceneState of_source(resolved, make_scene(resolved), {});
  EXPECT_EQ(of_source.time(), 0.5);
  EXPECT_FALSE(of_source.description().layers[0].field.options.time);
  EXPECT_EQ(of_source.times().size(), 3U);
}

TEST(Time, ShowsTheNearestStepAndIsSaved) {
  SceneState state = steps();
  EXPECT_EQ(state.time(), 0);
  for (const double time : {2.0, 0.4, 0.0}) {
    state.set_time(time);
    EXPECT_EQ(state.time(), time);
    const Json saved = Json::parse(state.saved());
    EXPECT_EQ(saved["time"], time);
    EXPECT_FALSE(saved["layers"][0]["field"].contains("time"));
    SceneDescription again = parse_scene(state.saved(), "saved");
    EXPECT_EQ(pixels_of(state.scene()), pixels_of(make_scene(again)));
    again.time = time == 0.4 ? 0.5 : time;
    EXPECT_EQ(pixels_of(state.scene()), pixels_of(make_scene(again)));
  }
  EXPECT_FALSE(state.can_undo());
  expect_error(error_of([] { shells().set_time(1); }), "no data of the scene have steps");
}

TEST(Time, StaysWhenEditsAreUndone) {
  SceneState state = steps();
  state.edit({{}, "clip", Json::parse(R"([{"sphere": {"center": [1, 1, 1], "radius": 1}}])"), 1});
  state.set_time(2);
  state.undo();
  EXPECT_EQ(state.time(), 2);
  EXPECT_EQ(pixels_of(state.scene()), pixels_of(make_scene(parse_scene(state.saved(), "saved"))));
}

/// A NIfTI of three volumes in time, 2 s apart, of 4 x 4 x 4 floats that are the volume's number.
fs::path nifti_with_steps() {
  static const TemporaryFolder folder("NIfTI of a test");
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t{348});
  constexpr std::array<std::int16_t, 5> sides{4, 4, 4, 4, 3};
  for (std::size_t i = 0; i < sides.size(); ++i) put(40 + 2 * i, sides[i]);
  put(70, std::int16_t{16});  // float
  put(72, std::int16_t{32});
  for (std::size_t i = 0; i < 5; ++i) put(76 + 4 * i, i == 4 ? 2.0F : 1.0F);
  put(108, 352.0F);
  bytes[123] = 2 | 8;  // mm and s
  bytes.replace(344, 3, "n+1");
  for (int step = 0; step < 3; ++step) {
    for (int i = 0; i < 64; ++i) {
      const float value = static_cast<float>(step) + static_cast<float>(i) / 64;
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  const fs::path path = folder.path() / "steps.nii";
  write_text_file(path, bytes);
  return path;
}

SceneState state_of_file(const fs::path& file) {
  ViewedScene viewed = view_input(file.string(), {});
  return {std::move(viewed.description), std::move(viewed.scene), {}};
}

TEST(Time, OfFilesThatAreOpenedIsTheFirst) {
  for (const fs::path& file : {nifti_with_steps(), file_with_steps()}) {
    SceneState state = state_of_file(file);
    EXPECT_EQ(state.times().size(), 3U) << file;
    EXPECT_EQ(state.time(), 0) << file;
    const Pixels first = pixels_of(state.scene());
    state.set_time(state.times()[2]);
    EXPECT_NE(pixels_of(state.scene()), first) << file;
  }
}

TEST(Time, HasTheUnitOfTheFile) {
  const SceneState medical = state_of_file(nifti_with_steps());
  const auto timeline = [](const SceneState& state) {
    return scene_json(state, file_choices(state.description()))["timeline"];
  };
  EXPECT_EQ(timeline(medical)["time_unit"], "s");
  EXPECT_EQ(timeline(steps())["time_unit"], "");
}

TEST(Time, ThatNoSceneCanNameIsLeftOut) {
  const SceneState state = state_of_file(file_with_steps("0 0.5 1e300"));
  EXPECT_EQ(state.times(), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(state.times_left_out(), 1U);
}

TEST(Film, KeyframesHoldCameraAndWhatChanged) {
  SceneState state = shells();
  state.set_film_length(2, 4);
  EXPECT_FALSE(state.description().animation);
  state.set_camera(from(4, 0, 1));
  state.set_keyframe();
  state.show_frame(4);
  state.edit({0, "isosurfaces", Json::parse(R"([{"value": 0.8}])"), 1});
  state.set_camera(from(0, 1, 4));
  state.set_keyframe();
  const Animation& film = *state.description().animation;
  ASSERT_EQ(film.cameras.size(), 2U);
  EXPECT_EQ(film.cameras[0].at, 0.0);
  EXPECT_EQ(film.cameras[1].at, 1.0);
  EXPECT_EQ(film.cameras[1].camera.position, (Vec3<double>{0, 1, 4}));
  ASSERT_EQ(film.tracks.size(), 1U);
  EXPECT_EQ(film.tracks[0].target, "/layers/0/isosurfaces");
  ASSERT_EQ(film.tracks[0].keys.size(), 2U);
  EXPECT_EQ(Json::parse(film.tracks[0].keys[0].value)[0]["value"], 0.5);
  EXPECT_EQ(film.tracks[0].keys[1].at, 1);
  const std::vector<Keyframe> keyframes = keyframes_of(film);
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_TRUE(keyframes[1].has_camera);
  EXPECT_EQ(keyframes[1].targets, std::vector<std::string>{"/layers/0/isosurfaces"});
  EXPECT_EQ(keyframe_at(keyframes, 4, 4), 1U);
  EXPECT_FALSE(keyframe_at(keyframes, 2, 4));
}

TEST(Film, ShowsFramesToTheBitAsTheSavedSceneIsAnimated) {
  SceneState state = steps();
  state.set_film_length(2, 4);
  state.set_camera(from(9, 1, 2));
  state.set_time(0.5);
  state.set_keyframe();
  state.show_frame(6);
  state.set_time(2);
  state.set_camera(from(1, 2, 9));
  state.set_keyframe();
  const Json track = Json::parse(animation_to_json(*state.description().animation))["tracks"][0];
  EXPECT_EQ(track["target"], "/time");
  EXPECT_EQ(track["keys"], Json::parse(R"([{"at": 0.0, "value": 0.5}, {"at": 1.5, "value": 2}])"));
  for (const int frame : {3, 0, 5, 7}) {
    state.show_frame(frame);
    EXPECT_EQ(state.frame(), frame);
    EXPECT_EQ(pixels_of(state.scene()), film_pixels(state, frame)) << frame;
    EXPECT_EQ(state.time(), std::min(2.0, 0.5 + 1.5 * frame / 6)) << frame;
  }
  EXPECT_EQ(film_pixels(state, 7), film_pixels(state, 6));
  EXPECT_NE(film_pixels(state, 0), film_pixels(state, 6));
}

TEST(Film, TheFunctionOfAllStepsIsNoEdit) {
  SceneState state = state_of(R"({"field": {"file": ")" + file_with_steps().string() + R"("}})");
  SceneDescription asked = state.with_open_function(0);
  ASSERT_EQ(choose_for_all_steps(asked, state.scene_times()), std::vector<std::size_t>{0});
  state.set_film_length(2, 4);
  state.set_keyframe();
  state.show_frame(6);
  state.set_camera(from(1, 2, 9));
  state.set_keyframe();
  const std::string before = state.function_text(0);
  SceneState other = state;
  other.take_choice(0, asked.layers[0]);
  other.set_keyframe();
  EXPECT_TRUE(other.description().animation->tracks.empty());
  state.edit(Edit{0, "visible", false, 0});
  state.take_choice(0, asked.layers[0]);
  const std::string chosen = state.function_text(0);
  EXPECT_NE(chosen, before);
  EXPECT_FALSE(state.scene().layers[0].visible);
  // It is that of the steps before it in the history, and no part of a keyframe.
  state.undo();
  EXPECT_EQ(state.function_text(0), chosen);
  EXPECT_TRUE(state.scene().layers[0].visible);
  state.set_keyframe();
  EXPECT_TRUE(state.description().animation->tracks.empty());
  // Nor is it taken where the function was edited.
  SceneDescription edited = state.description();
  EXPECT_TRUE(SceneState::have_same_look(edited.layers[0], state.description().layers[0]));
  edited.layers[0].visible = false;
  EXPECT_TRUE(SceneState::have_same_look(edited.layers[0], state.description().layers[0]));
  edited.layers[0].isosurfaces.push_back({});
  EXPECT_FALSE(SceneState::have_same_look(edited.layers[0], state.description().layers[0]));
}

TEST(Film, TurntableStartsFromWhatIsSeen) {
  SceneState state = shells();
  state.set_camera(from(4, 1, 0));
  state.set_turntable(1);
  const Pixels first = film_pixels(state, 0);
  EXPECT_EQ(pixels_of(state.scene()), first);
  state.show_frame(30);
  EXPECT_EQ(pixels_of(state.scene()), film_pixels(state, 30));
  EXPECT_NE(pixels_of(state.scene()), first);
  EXPECT_EQ(film_pixels(state, 0), first);
  // The saved scene has the camera of the start; a camera that is moved is a new one.
  state.set_camera(from(0, 1, 4));
  EXPECT_EQ(state.frame(), 0);
  EXPECT_EQ(film_pixels(state, 0), pixels_of(state.scene()));
}

TEST(Film, KeyframesMoveScaleAndGo) {
  SceneState state = shells();
  state.set_film_length(2, 4);
  state.set_keyframe();
  state.show_frame(4);
  state.set_camera(from(0, 1, 4));
  state.set_keyframe();
  state.move_keyframe(1, 6);
  EXPECT_EQ(state.description().animation->cameras[1].at, 1.5);
  EXPECT_EQ(state.frame(), 4);
  expect_error(error_of([&] { state.move_keyframe(1, 0); }), "another one is at 0 s");
  expect_error(error_of([&] { state.move_keyframe(2, 3); }), "there are 2 keyframes only");
  expect_error(error_of([&] { state.delete_keyframe(7); }), "keyframe 8: there are 2");
  expect_error(error_of([&] { state.show_frame(8); }), "there is no frame 8; it has 8");
  state.set_film_length(4, 8);
  EXPECT_EQ(state.description().animation->cameras[1].at, 3.0);
  state.undo();
  EXPECT_EQ(state.description().animation->cameras[1].at, 1.5);
  state.undo();
  EXPECT_EQ(state.description().animation->cameras[1].at, 1.0);
  state.delete_keyframe(0);
  EXPECT_EQ(state.description().animation->cameras.size(), 1U);
  state.delete_keyframe(0);
  EXPECT_FALSE(state.description().animation);
  EXPECT_EQ(state.film_length().seconds, 2);
  state.undo();
  state.undo();
  EXPECT_EQ(state.description().animation->cameras.size(), 2U);
  state.remove_film();
  EXPECT_FALSE(state.description().animation);
}

TEST(Film, AnUndoneKeyframeIsMadeAgain) {
  SceneState state = shells();
  state.set_keyframe();
  state.show_frame(48);
  state.edit({0, "isosurfaces", Json::parse(R"([{"value": 0.8}])"), 1});
  state.set_keyframe();
  EXPECT_EQ(state.description().animation->tracks.size(), 1U);
  state.undo();
  EXPECT_TRUE(state.description().animation->tracks.empty());
  state.set_keyframe();
  EXPECT_EQ(state.description().animation->tracks.size(), 1U);
}

TEST(Film, KeyframesHoldWhatASceneLacks) {
  // Without shading and lights first, with them later.
  SceneState state = state_of(R"({"field": {"builtin": "shells", "points": 16},
                                  "isosurfaces": [{"value": 0.5}]})");
  state.set_film_length(1, 8);
  state.set_keyframe();
  const Pixels unlit = pixels_of(state.scene());
  state.show_frame(6);
  state.edit({0, "shading", Json::parse(R"({"diffuse": 0.9})"), 1});
  state.edit(
      {{}, "lights", Json::parse(R"([{"type": "directional", "direction": [0, 1, 1]}])"), 2});
  state.set_keyframe();
  const Pixels lit = pixels_of(state.scene());
  EXPECT_NE(lit, unlit);
  EXPECT_EQ(state.description().animation->tracks.size(), 2U);
  state.show_frame(0);
  EXPECT_EQ(pixels_of(state.scene()), unlit);
  EXPECT_EQ(film_pixels(state, 0), unlit);
  EXPECT_EQ(film_pixels(state, 5), unlit);
  EXPECT_EQ(film_pixels(state, 6), lit);
  // The other way round.
  SceneState back = shells();
  back.set_film_length(1, 8);
  back.set_keyframe();
  const Pixels shaded = pixels_of(back.scene());
  back.show_frame(6);
  back.edit({0, "shading", nullptr, 1});
  back.set_keyframe();
  EXPECT_EQ(film_pixels(back, 0), shaded);
  EXPECT_NE(film_pixels(back, 6), shaded);
}

TEST(Film, ChangesThatWereSeenInTheWholeFilmStay) {
  SceneState state = shells();
  state.set_film_length(1, 8);
  state.set_keyframe();
  state.show_frame(6);
  state.set_keyframe();
  state.edit({0, "isosurfaces", Json::parse(R"([{"value": 0.8}])"), 1});
  state.show_frame(0);
  const Pixels seen = pixels_of(state.scene());
  state.show_frame(3);
  state.set_keyframe();
  EXPECT_TRUE(state.description().animation->tracks.empty());
  EXPECT_EQ(film_pixels(state, 0), seen);
  EXPECT_EQ(film_pixels(state, 6), seen);
}

TEST(Film, ChangesShowTheFramesOfTheFilm) {
  SceneState state = shells();
  state.set_film_length(2, 4);
  state.set_camera(from(4, 0, 1));
  state.set_keyframe();
  state.show_frame(6);
  state.set_camera(from(0, 1, 4));
  state.set_keyframe();
  state.show_frame(3);
  const auto expect_shown = [&](const char* what) {
    EXPECT_EQ(pixels_of(state.scene()), film_pixels(state, state.frame())) << what;
  };
  state.move_keyframe(1, 4);
  expect_shown("moved");
  state.undo();
  expect_shown("undone");
  state.redo();
  expect_shown("made again");
  state.set_film_length(3, 4);
  expect_shown("longer");
  state.delete_keyframe(1);
  expect_shown("deleted");
  // An edit that is in no keyframe is gone with its moment, also from the history.
  state.undo();
  state.show_frame(2);
  state.set_camera(from(4, 0, 1));
  state.undo();
  expect_shown("undone elsewhere");
}

TEST(Film, AnUndoneKeyframeLeavesTheTimeThatWasChosen) {
  SceneState state = steps();
  state.set_film_length(2, 4);
  state.set_time(0.5);
  state.set_keyframe();
  state.show_frame(6);
  state.set_time(2);
  state.set_keyframe();
  state.show_frame(3);
  EXPECT_EQ(state.time(), 1.25);
  state.undo();
  EXPECT_EQ(state.time(), 2);
  EXPECT_EQ(pixels_of(state.scene()), film_pixels(state, 3));
}

TEST(Film, TimesOfAFilmThatMovesEvenlyBecomeKeys) {
  SceneState state = steps(R"(, "animation": {"seconds": 2, "fps": 4, "time": [0, 2]})");
  const Pixels end = film_pixels(state, 7);
  state.show_frame(4);
  EXPECT_DOUBLE_EQ(state.time(), 8.0 / 7);
  state.set_time(0.5);
  state.set_keyframe();
  const Animation& film = *state.description().animation;
  EXPECT_FALSE(film.time);
  ASSERT_EQ(film.tracks.size(), 1U);
  EXPECT_EQ(film.tracks[0].keys.size(), 3U);
  state.show_frame(0);
  state.show_frame(4);
  EXPECT_EQ(state.time(), 0.5);
  EXPECT_EQ(film_pixels(state, 7), end);
  // Steps, too: without keyframes they are at the first and the last frame.
  SceneState even = steps(R"(, "animation": {"seconds": 2, "fps": 4, "time": "steps"})");
  even.show_frame(0);
  even.set_time(2);
  even.set_keyframe();
  ASSERT_EQ(even.description().animation->tracks.size(), 1U);
  even.show_frame(7);
  even.show_frame(0);
  EXPECT_EQ(even.time(), 2);
  even.show_frame(7);
  EXPECT_EQ(even.time(), 2);
}

TEST(Film, KeyframesKeepTheStepsOfTime) {
  SceneState state = steps();
  state.set_film_length(2, 3);
  state.show_frame(3);
  EXPECT_EQ(state.time(), 0);
  state.set_keyframe();
  EXPECT_TRUE(state.description().animation->by_steps);
  EXPECT_EQ(state.time(), 0.5);
  EXPECT_EQ(pixels_of(state.scene()), film_pixels(state, 3));
  // A keyframe with another time puts times into all of them.
  state.show_frame(5);
  state.set_time(0);
  state.set_keyframe();
  const Animation& film = *state.description().animation;
  EXPECT_FALSE(film.by_steps);
  ASSERT_EQ(film.tracks.size(), 1U);
  ASSERT_EQ(film.tracks[0].keys.size(), 2U);
  EXPECT_EQ(film.tracks[0].keys[0].value, "0.5");
  EXPECT_EQ(film.tracks[0].keys[1].value, "0");
  state.undo();
  EXPECT_TRUE(state.description().animation->by_steps);
  state.undo();
  EXPECT_FALSE(state.description().animation);
  // A time that was chosen before is held.
  SceneState still = steps();
  still.set_time(2);
  still.set_keyframe();
  EXPECT_FALSE(still.description().animation->moves_data());
  still.show_frame(100);
  EXPECT_EQ(still.time(), 2);
}

TEST(Film, KeyframesKeepTheTurn) {
  for (const double turns : {1.0, -0.3, 2.25}) {
    SceneState state = shells();
    state.set_film_length(2.03, 8);  // 16 frames
    state.set_camera(from(4, 1, 0.5));
    state.set_turntable(turns);
    std::vector<Camera> turned;
    for (int frame = 0; frame < 16; ++frame) {
      state.show_frame(frame);
      turned.push_back(state.scene().camera);
    }
    state.show_frame(5);
    state.set_keyframe();
    EXPECT_FALSE(state.description().animation->turntable);
    for (int frame = 0; frame < 16; ++frame) {
      state.show_frame(frame);
      const CameraFrame<double> is = make_camera_frame(state.scene().camera, {1, 1});
      const CameraFrame<double> was =
          make_camera_frame(turned[static_cast<std::size_t>(frame)], {1, 1});
      EXPECT_LT(length(is.position - was.position), 1e-4) << turns << " turns, frame " << frame;
      EXPECT_LT(length(is.up - was.up), 1e-4) << turns << " turns, frame " << frame;
    }
  }
  SceneState many = shells();
  many.set_turntable(26);
  expect_error(error_of([&] { many.set_keyframe(); }), "25 turns are the most");
}

TEST(Film, LongOnesAreEditedAtOnce) {
  SceneState state = shells();
  state.set_film_length(86400, 11);
  state.set_keyframe();
  state.show_frame(900'000);
  state.edit({0, "isosurfaces", Json::parse(R"([{"value": 0.8}])"), 1});
  const auto start = std::chrono::steady_clock::now();
  state.set_keyframe();
  state.move_keyframe(1, 800'000);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_LT(taken.count(), 2);
  EXPECT_EQ(state.description().animation->tracks.size(), 1U);
}

TEST(Film, FramesBetweenKeysAreCheckedWhenTheyAreMade) {
  SceneDescription scene = shells().description();
  // Its normal has no length in frame 25 alone.
  scene.animation = parse_animation(R"({"seconds": 1, "fps": 100, "tracks": [{"target": "/clip",
      "keys": [{"at": 0, "value": [{"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}}]},
               {"at": 1, "value": [{"plane": {"point": [0, 0, 0], "normal": [-3, 0, 0]}}]}]}]})",
                                    "test");
  const Film film(scene, scene, *scene.animation, SceneTimes(scene));
  EXPECT_EQ(film.frames(), 100);
  film.description(24);
  expect_error(error_of([&] { film.description(25); }), "frame 26");
  expect_error(error_of([&] { film.check(); }), "frame 26");
  EXPECT_FALSE(film.check([] { return true; }));
  // What fails everywhere fails at once.
  scene.animation->tracks[0] = {"/layers/0/field/points", Easing::linear, {{0, "8"}, {1, "9"}}};
  expect_error(error_of([&] { Film(scene, scene, *scene.animation, SceneTimes(scene)); }), "frame");
}

TEST(Film, AKeyframeThatNoFrameShowsIsRenewed) {
  SceneState state = shells();
  state.set_film_length(1, 8);
  state.set_camera(from(4, 0, 1));
  state.set_keyframe();
  state.show_frame(7);
  state.set_camera(from(0, 1, 4));
  state.set_keyframe();
  SceneDescription description = state.description();
  description.animation->cameras[1].at = 1;  // the film's end, behind its last frame
  SceneState end(description, state.scene(), {});
  end.show_frame(7);
  end.set_camera(from(0, 2, 5));
  end.set_keyframe(1);
  const Animation& film = *end.description().animation;
  ASSERT_EQ(film.cameras.size(), 2U);
  EXPECT_EQ(film.cameras[1].at, 1.0);
  EXPECT_EQ(film.cameras[1].camera.position, (Vec3<double>{0, 2, 5}));
  expect_error(error_of([&] { end.set_keyframe(2); }), "keyframe 3: there are 2 keyframes only");
}

TEST(Film, TracksOfTheCameraKeepMovingIt) {
  SceneState state = state_of(R"({"field": {"builtin": "shells", "points": 16}})",
                              R"(, "animation": {"seconds": 2, "fps": 4, "tracks": [
      {"target": "/camera/vertical_angle", "keys": [{"at": 0, "value": 10},
                                                    {"at": 2, "value": 40}]}]})");
  const Pixels first = film_pixels(state, 0), last = film_pixels(state, 7);
  EXPECT_NE(first, last);
  state.show_frame(4);
  state.set_keyframe();
  EXPECT_TRUE(state.description().animation->cameras.empty());
  EXPECT_EQ(state.description().animation->tracks[0].keys.size(), 3U);
  EXPECT_EQ(film_pixels(state, 0), first);
  EXPECT_EQ(film_pixels(state, 7), last);
}

TEST(Film, AChosenLengthIsSaved) {
  SceneState state = steps();
  EXPECT_FALSE(parse_scene(state.saved(), "saved").animation);
  state.set_film_length(2, 10);
  const Animation saved = *parse_scene(state.saved(), "saved").animation;
  EXPECT_EQ(frame_count(saved), 20);
  EXPECT_EQ(animation_to_json(saved), animation_to_json(state.film_to_save()));
  SceneState turned = shells();
  turned.set_film_length(1, 8);
  turned.set_turntable(1);
  turned.remove_film();
  EXPECT_EQ(turned.film_length().seconds, turned.film_to_save().seconds);
  EXPECT_FALSE(parse_scene(turned.saved(), "saved").animation);
}

TEST(Film, CamerasWithoutTimesGetEvenOnes) {
  SceneState state = state_of(R"({"field": {"builtin": "shells", "points": 16}})",
                              R"(, "animation": {"seconds": 4, "fps": 2, "cameras": [
         {"camera": {"position": [4, 0, 0], "focal_point": [0, 0, 0], "up": [0, 0, 1]}},
         {"camera": {"position": [0, 4, 0], "focal_point": [0, 0, 0], "up": [0, 0, 1]}},
         {"camera": {"position": [0, 0, 4], "focal_point": [0, 0, 0], "up": [0, 1, 0]}}]})");
  const Json timeline = scene_json(state, file_choices(state.description()))["timeline"];
  EXPECT_EQ(timeline["frames"], 8);
  ASSERT_EQ(timeline["keyframes"].size(), 3U);
  EXPECT_EQ(timeline["keyframes"][1]["at"], 2);
  EXPECT_EQ(timeline["keyframe"], 0);
  state.show_frame(4);
  EXPECT_EQ(pixels_of(state.scene()), film_pixels(state, 4));
  state.move_keyframe(1, 2);
  EXPECT_EQ(state.description().animation->cameras[1].at, 1.0);
  EXPECT_EQ(state.description().animation->cameras[2].at, 4.0);
}

TEST(Film, HandWrittenTracksGetKeys) {
  SceneState state =
      state_of(R"({"field": {"builtin": "shells", "points": 16}, "isosurfaces": [{"value": 0.2}]})",
               R"(, "animation": {"seconds": 1, "fps": 4, "tracks": [
         {"target": "/layers/0/isosurfaces/0/value", "keys": [{"at": 0, "value": 0.2}]}]})");
  state.show_frame(2);
  state.edit({0, "isosurfaces", Json::parse(R"([{"value": 0.6}])"), 1});
  state.set_keyframe();
  const Animation& film = *state.description().animation;
  ASSERT_EQ(film.tracks.size(), 1U);
  ASSERT_EQ(film.tracks[0].keys.size(), 2U);
  EXPECT_EQ(film.tracks[0].keys[1].value, "0.6");
}

TEST(FilmJob, MakesAFileOrSaysWhy) {
  SceneState state = shells();
  state.set_film_length(0.5, 4);
  state.set_keyframe();
  SavedFile saved;
  std::string failure = "it has not ended";
  int last = 0;
  const auto run = [&](const SaveFilm& wanted, bool cancels) {
    FilmJob job(
        state, wanted, 1, [&](const SavedFilmProgress& progress) { last = progress.frame; },
        [&](SavedFile file, const std::string& why) {
          saved = std::move(file);
          failure = why;
        });
    if (cancels) job.cancel();
    while (!job.has_ended()) std::this_thread::yield();
  };
  run({16, 12, 1.0 / 512, "zip"}, false);
  EXPECT_EQ(failure, "");
  EXPECT_EQ(saved.name, "film.zip");
  EXPECT_EQ(saved.bytes.substr(0, 2), "PK");
  EXPECT_NE(saved.bytes.find("0001.png"), std::string::npos);
  EXPECT_EQ(saved.bytes.find("0002.png"), std::string::npos);
  EXPECT_EQ(last, 3);  // behind the last frame: the file is being made
  run({4000, 4000, 1e-6, "zip"}, true);
  expect_error(failure, "cancelled; no file is left");
  EXPECT_TRUE(saved.bytes.empty());
}

TEST(ParseCommand, ReadsTheFilm) {
  const auto parsed = [](const char* text) { return parse_command(text); };
  EXPECT_EQ(std::get<SetTime>(parsed(R"({"type": "scene_time", "time": 2.5})")).time, 2.5);
  EXPECT_EQ(std::get<ShowFilmFrame>(parsed(R"({"type": "film_frame", "frame": 7})")).frame, 7);
  const auto move = std::get<EditFilm>(
      parsed(R"({"type": "film", "action": "move_keyframe", "keyframe": 1, "frame": 3})"));
  EXPECT_EQ(move.action, EditFilm::Action::move_keyframe);
  EXPECT_EQ(move.keyframe, 1U);
  EXPECT_EQ(move.frame, 3);
  const auto save = std::get<SaveFilm>(parsed(
      R"({"type": "save_film", "width": 64, "height": 48, "tolerance": 0.01, "format": "mp4"})"));
  EXPECT_EQ(save.format, "mp4");
  const auto refused = [&](const char* text, const char* part) {
    expect_error(error_of([&] { parsed(text); }), part);
  };
  refused(R"({"type": "film_frame", "frame": -1})", "frame is -1");
  refused(R"({"type": "film", "action": "dance"})", "must be one of set_keyframe");
  refused(R"({"type": "film", "action": "length", "seconds": 0, "fps": 24})", "seconds is 0");
  refused(R"({"type": "film", "action": "move_keyframe", "frame": 3})", "keyframe is missing");
  refused(R"({"type": "save_film", "width": 0, "height": 48, "tolerance": 1, "format": "zip"})",
          "width is 0");
  refused(R"({"type": "save_film", "width": 9, "height": 9, "tolerance": 0.1, "format": "avi"})",
          "must be one of webm, mp4, zip");
  refused(R"({"type": "scene_time", "time": null})", "time is not a number");
}

/// A program of the name ffmpeg that encodes nothing, in front of PATH while this lives.
class FakeFfmpeg {
 public:
  explicit FakeFfmpeg(const std::string& encoding) : paths_(std::getenv("PATH")) {
    const fs::path program = folder_.path() / "ffmpeg";
    write_text_file(program, "#!/bin/sh\ncase \"$*\" in *lavfi*) exit 0 ;; esac\n" + encoding);
    fs::permissions(program, fs::perms::owner_all);
    setenv("PATH", (folder_.path().string() + ":" + paths_).c_str(), 1);
  }
  ~FakeFfmpeg() { setenv("PATH", paths_.c_str(), 1); }
  FakeFfmpeg(const FakeFfmpeg&) = delete;
  FakeFfmpeg& operator=(const FakeFfmpeg&) = delete;

  const fs::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_{"a program of a test"};
  std::string paths_;
};

/// End of a film of two small frames.
struct FilmEnd {
  SavedFile file;
  std::string failure;
  double seconds = 0;
  std::vector<int> frames;  ///< that were told
};

/// Saves it, and cancels it once `cancel_at` frames are done.
FilmEnd saved_film(const SaveFilm& wanted, int cancel_at = 100,
                   std::uintmax_t most_bytes = largest_film) {
  SceneState state = shells();
  state.set_film_length(1, 4);
  state.set_keyframe();
  FilmEnd end;
  std::atomic<int> done = 0;
  const auto start = std::chrono::steady_clock::now();
  FilmJob job(
      state, wanted, 1,
      [&](const SavedFilmProgress& progress) {
        end.frames.push_back(progress.frame);
        done = progress.frame - 1;
      },
      [&](SavedFile file, const std::string& why) {
        end.file = std::move(file);
        end.failure = why;
      },
      most_bytes);
  while (!job.has_ended()) {
    if (done >= cancel_at) job.cancel();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  end.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return end;
}

TEST(FilmJob, EndsTheEncoderWhenItIsCancelled) {
  const FakeFfmpeg silent("exec sleep 60\n");
  const FilmEnd end = saved_film({16, 12, 1.0 / 512, "webm"}, 4);
  expect_error(end.failure, "cancelled; no file is left");
  EXPECT_LT(end.seconds, 30);
  EXPECT_EQ(end.frames.back(), 5);
}

TEST(FilmJob, EndsAnEncoderThatClosedItsOutput) {
  const FakeFfmpeg deaf("exec sleep 60 2>&-\n");
  const FilmEnd end = saved_film({16, 12, 1.0 / 512, "mp4"}, 4);
  expect_error(end.failure, "cancelled; no file is left");
  EXPECT_LT(end.seconds, 30);
}

TEST(FilmJob, TellsOfAFailureBehindItsFirstProgress) {
  const FakeFfmpeg failing("echo no such encoder >&2; exit 1\n");
  const FilmEnd end = saved_film({16, 12, 1.0 / 512, "webm"});
  expect_error(end.failure, "ffmpeg failed: no such encoder");
  EXPECT_EQ(end.frames.front(), 1);
}

TEST(FilmJob, EndsAsSoonAsThePicturesAreTooMany) {
  const FilmEnd end = saved_film({64, 48, 1.0 / 512, "zip"}, 100, 1000);
  expect_error(end.failure, "more than 0 MB, the most that a page can be given");
  EXPECT_TRUE(end.file.bytes.empty());
  EXPECT_LT(end.frames.back(), 4);
}

TEST(FilmFiles, LeaveNoVideoThatWasEnded) {
  const FakeFfmpeg slow("for last; do :; done; echo part > \"${last#file:}\"; exec sleep 60\n");
  const fs::path path = slow.folder() / "film.webm";
  const FilmFiles files(path);
  Image image;
  image.width = image.height = 2;
  image.pixels.resize(4);
  files.write(0, image, "a test", {});
  int asked = 0;
  EXPECT_FALSE(files.finish(1, 24, false, [&] { return ++asked > 10; }));
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(slow.folder())) {
    names.push_back(entry.path().filename());
  }
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"ffmpeg", "film.webm.frames"}));
}

TEST(ParseCommand, ReadsTheKeyframeThatIsChosen) {
  const auto film = [](const char* text) { return std::get<EditFilm>(parse_command(text)); };
  EXPECT_EQ(film(R"({"type": "film", "action": "set_keyframe", "keyframe": 2})").chosen, 2U);
  EXPECT_FALSE(film(R"({"type": "film", "action": "set_keyframe"})").chosen);
  EXPECT_TRUE(std::holds_alternative<TakeFilm>(parse_command(R"({"type": "film_taken"})")));
}

}  // namespace
}  // namespace pellucid::view::film_test
