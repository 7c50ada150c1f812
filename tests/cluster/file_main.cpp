// SPDX-License-Identifier: Apache-2.0
//
// Reads files in bricks on all ranks of the program, and holds each part against the whole file,
// and the picture against that of one process; then files that are damaged:
//
//   mpirun -n N test_rank_files FOLDER
//
// Rank 0 writes the files into the folder.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#ifdef PELLUCID_HAVE_HDF5
#include <hdf5.h>
#endif

#include "pellucid/cluster/load.h"
#include "pellucid/cluster/render.h"
#include "pellucid/cluster/sub_scene.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/reference/render.h"
#include "pellucid/scene/image_difference.h"

namespace {

using namespace pellucid;
namespace fs = std::filesystem;

constexpr int nx = 44, ny = 31, nz = 37;

std::vector<std::int16_t> values() {
  std::vector<std::int16_t> list;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const double wave =
            std::sin(0.21 * i) * std::cos(0.17 * j + 0.1 * k) + 0.3 * std::sin(0.4 * k);
        list.push_back(static_cast<std::int16_t>(std::lround(1000 * wave)));
      }
    }
  }
  return list;
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

#ifdef PELLUCID_HAVE_HDF5

/// `chunk`: its side, with checksums, and compressed if `deflate`; 0: contiguous.
void write_hdf5(const fs::path& file, hsize_t chunk, bool deflate = true) {
  const std::vector<hsize_t> shape{nz, ny, nx}, chunks(3, chunk);
  const hid_t to = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  if (chunk > 0) {
    H5Pset_chunk(how, 3, chunks.data());
    if (deflate) H5Pset_deflate(how, 6);
    H5Pset_fletcher32(how);
  }
  const hid_t space = H5Screate_simple(3, shape.data(), nullptr);
  const hid_t set = H5Dcreate2(to, "v", H5T_STD_I16LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_INT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, values().data());
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(how);
  H5Fclose(to);
}

/// A bit of the last value is wrong, which the checksum of its chunk tells.
void write_damaged_hdf5(const fs::path& file) {
  write_hdf5(file, 8, false);
  std::string bytes = text_of(file);
  const std::vector<std::int16_t> all = values();
  const std::string last(reinterpret_cast<const char*>(all.data() + all.size() - 4), 8);
  const std::size_t at = bytes.rfind(last);
  if (at != std::string::npos) bytes[at + 6] = static_cast<char>(bytes[at + 6] ^ 1);
  write_text(file, bytes);
}

#endif

#ifdef PELLUCID_HAVE_VTK

struct Piece {
  int extent[6];
  std::string file;
};

std::string numbers(const int (&extent)[6]) {
  std::string text;
  for (const int n : extent) text += std::to_string(n) + " ";
  return text;
}

std::string vtk(const std::string& kind, const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + kind +
         " WholeExtent=\"" + content + "</VTKFile>\n";
}

constexpr const char* placed = " Origin=\"0 0 0\" Spacing=\"1 1 1\">";

/// The values of an extent, appended as they lie in memory.
void write_piece(const fs::path& file, const int (&extent)[6]) {
  const std::vector<std::int16_t> all = values();
  std::string bytes(8, '\0');
  for (int k = extent[4]; k <= extent[5]; ++k) {
    for (int j = extent[2]; j <= extent[3]; ++j) {
      for (int i = extent[0]; i <= extent[1]; ++i) {
        const std::int16_t value = all[static_cast<std::size_t>(i + nx * (j + ny * k))];
        char raw[2];
        std::memcpy(raw, &value, 2);
        bytes.append(raw, 2);
      }
    }
  }
  const std::uint64_t size = bytes.size() - 8;
  std::memcpy(bytes.data(), &size, 8);
  write_text(file, vtk("ImageData",
                       numbers(extent) + "\"" + placed + "<Piece Extent=\"" + numbers(extent) +
                           "\"><PointData Scalars=\"v\"><DataArray type=\"Int16\" Name=\"v\" "
                           "format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData>"
                           "<AppendedData encoding=\"raw\">_" +
                           bytes + "</AppendedData>"));
}

std::vector<Piece> pieces() {
  return {{{0, 20, 0, ny - 1, 0, 18}, "p0.vti"},
          {{20, nx - 1, 0, ny - 1, 0, 18}, "p1.vti"},
          {{0, nx - 1, 0, 15, 18, nz - 1}, "p2.vti"},
          {{0, nx - 1, 15, ny - 1, 18, nz - 1}, "p3.vti"}};
}

void write_list(const fs::path& file, const std::vector<Piece>& list) {
  const int whole[6] = {0, nx - 1, 0, ny - 1, 0, nz - 1};
  std::string text =
      numbers(whole) + "\" GhostLevel=\"0\"" + placed +
      "<PPointData Scalars=\"v\"><PDataArray type=\"Int16\" Name=\"v\"/></PPointData>";
  for (const Piece& piece : list) {
    text += "<Piece Extent=\"" + numbers(piece.extent) + "\" Source=\"" + piece.file + "\"/>";
  }
  write_text(file, vtk("PImageData", text + "</PImageData>"));
}

#endif

struct Files {
  std::vector<std::string> good, damaged;
};

/// Names on all ranks; rank 0 writes.
Files make_files(const fs::path& folder, bool writes) {
  Files files;
#ifdef PELLUCID_HAVE_HDF5
  if (writes) {
    write_hdf5(folder / "contiguous.h5", 0);
    write_hdf5(folder / "chunked.h5", 9);
    write_damaged_hdf5(folder / "damaged.h5");
    const std::string whole = text_of(folder / "chunked.h5");
    write_text(folder / "cut.h5", whole.substr(0, 2 * whole.size() / 3));
  }
  files.good.insert(files.good.end(), {"contiguous.h5", "chunked.h5"});
  files.damaged.insert(files.damaged.end(), {"damaged.h5", "cut.h5"});
#endif
#ifdef PELLUCID_HAVE_VTK
  if (writes) {
    write_piece(folder / "whole.vti", {0, nx - 1, 0, ny - 1, 0, nz - 1});
    for (const Piece& piece : pieces()) write_piece(folder / piece.file, piece.extent);
    write_list(folder / "pieces.pvti", pieces());
    std::vector<Piece> list = pieces();
    list[3].file = "none.vti";
    write_list(folder / "missing.pvti", list);
    list = pieces();
    list.pop_back();
    write_list(folder / "gap.pvti", list);
    list = pieces();
    std::swap(list[0].file, list[3].file);
    write_list(folder / "lies.pvti", list);
    list = pieces();
    list[2].file = "short.vti";
    write_list(folder / "short.pvti", list);
    const std::string piece = text_of(folder / "p2.vti");
    write_text(folder / "short.vti", piece.substr(0, piece.size() / 2));
  }
  files.good.insert(files.good.end(), {"whole.vti", "pieces.pvti"});
  files.damaged.insert(files.damaged.end(),
                       {"missing.pvti", "gap.pvti", "lies.pvti", "short.pvti"});
#endif
  return files;
}

SceneDescription describe(const fs::path& file) {
  return parse_scene(
      R"({"pellucid": 2, "image": {"width": 24, "height": 20}, "layers": [{"field": {"file": ")" +
          file.string() +
          R"("}, "shading": {}, "transfer_function": {"points": [
            {"value": -200, "extinction": 0, "color": [0.1, 0.3, 1]},
            {"value": 400, "extinction": 0.05, "color": [1, 0.6, 0.2]},
            {"value": 1200, "extinction": 0.4, "color": [1, 1, 0.9]}]}}]})",
      "scene");
}

/// Returns whether the rank's part has no more than its share, and the values of the whole.
bool is_part(const BrickedScene& bricks, int rank, const fs::path& file) {
  const Volume whole = read_volume(file);
  const Volume& part = *grid_of(bricks.scene.layers[0]);
  const IndexBox box = indices_of_brick(whole.description(), {}, bricks.tree, rank);
  if (part.description().dimensions != box.count) {
    std::printf("FAILED %s: rank %d has %d x %d x %d values\n", file.c_str(), rank,
                part.description().dimensions[0], part.description().dimensions[1],
                part.description().dimensions[2]);
    return false;
  }
  const VolumeData expected = sub_values(whole.data(), whole.description().dimensions, box);
  const auto& a = std::get<DataArray<std::int16_t>>(expected);
  const auto& b = std::get<DataArray<std::int16_t>>(part.data());
  if (std::equal(a.begin(), a.end(), b.begin(), b.end())) return true;
  std::printf("FAILED %s: rank %d has other values\n", file.c_str(), rank);
  return false;
}

bool is_good(Communicator& ranks, const fs::path& file, BrickBalance balance) {
  const SceneDescription description = describe(file);
  const BrickedScene bricks = load_bricks(ranks, description, balance);
  bool right = is_part(bricks, ranks.rank(), file);
  if (!bricks.notes.empty()) {
    std::printf("FAILED %s\n", bricks.notes[0].c_str());
    right = false;
  }
  RenderOptions options;
  options.outputs.error = true;
  options.machine.threads = 1;
  const Image image = render(ranks, bricks.tree, bricks.scene, options).image;
  if (ranks.rank() == 0) {
    Scene whole = make_scene(description);
    whole.camera = bricks.scene.camera;
    const Image alone = render(whole, options).image, truth = render_reference(whole).image;
    for (const Image* const other : {&alone, &truth}) {
      const auto check = check_errors(image, *other);
      if (check && check->over == 0) continue;
      std::printf("FAILED %s: the picture is another\n", file.c_str());
      right = false;
    }
  }
  double wrong[] = {right ? 0.0 : 1.0};
  ranks.reduce_all(wrong, Communicator::Reduction::maximum);
  return wrong[0] == 0;
}

/// Returns whether all ranks say the same in one line.
bool is_refused(Communicator& ranks, const fs::path& file) {
  std::string message = "nothing is wrong";
  try {
    load_bricks(ranks, describe(file), BrickBalance::data);
  } catch (const AgreedError& error) {
    message = error.what();
  }
  bool right = message.find(file.filename().string()) != std::string::npos &&
               message.find('\n') == std::string::npos;
  for (const std::string& other : ranks.gather_all(message)) right = right && other == message;
  if (ranks.rank() == 0) std::printf("%s %s\n", right ? "refused" : "FAILED", message.c_str());
  return right;
}

int run(Communicator& ranks, const fs::path& folder) {
  if (ranks.rank() == 0) fs::create_directories(folder);
  const Files files = make_files(folder, ranks.rank() == 0);
  ranks.gather_all("");
  bool right = true;
  for (const std::string& file : files.good) {
    for (const BrickBalance balance : {BrickBalance::data, BrickBalance::work}) {
      const bool one = is_good(ranks, folder / file, balance);
      if (ranks.rank() == 0) std::printf("%s %s\n", one ? "ok    " : "FAILED", file.c_str());
      right = right && one;
    }
  }
  for (const std::string& file : files.damaged) right = is_refused(ranks, folder / file) && right;
  return right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto ranks =
        pellucid::is_under_mpi() ? pellucid::mpi_communicator() : pellucid::single_rank();
    const int status = run(*ranks, argc > 1 ? argv[1] : "rank_files");
    std::fflush(stdout);
    ranks->gather_all("");
    return status;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
