// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/embed_scene.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "embedded/coarser_scene.h"
#include "npy/write_npz.h"
#include "pellucid/scene/error.h"
#include "text/text.h"

namespace pellucid {

namespace {

/// The name of the array in an archive, as of other programs that save one.
constexpr const char* array_name = "values";

/// Files with names of their own; data that several layers share are one.
class Files {
 public:
  Files(std::uint64_t most_bytes, const CoarserVolumes& coarser)
      : most_bytes_(most_bytes), coarser_(coarser) {}

  /// Makes the field one of a file that holds the volume, or the one in its place. `name`: what to
  /// call it.
  FieldSource add(const Volume& given, std::string name, const FieldSource& from) {
    const auto in_its_place = coarser_.find(bytes_of(given));
    const Volume& volume = in_its_place == coarser_.end() ? given : *in_its_place->second;
    const auto [known, is_new] = file_of_.try_emplace(bytes_of(volume));
    FieldSource field;
    field.options.array = array_name;
    if (has_npz_matrix(volume.description())) field.options.axes = "xyz";
    // Uniform grids do not say it.
    if (volume.description().centering == Centering::cell) {
      field.options.centering = Centering::cell;
    }
    if (is_new) {
      known->second = name_for(std::move(name));
      std::string bytes;
      const bool is_file = from.builtin.empty() && has_source(from);
      write_npz({std::span(&volume, 1), array_name, known->second,
                 is_file ? world_space(from.file, from.options) : ""},
                to(bytes));
      files_.push_back({known->second, std::move(bytes)});
    }
    field.file = known->second;
    return field;
  }

  /// Adds a mesh likewise, whose channels are arrays then.
  MeshSource add(const MeshChannels& mesh, std::string name) {
    MeshSource source;
    const std::string file = name_for(std::move(name));
    source.file = file;
    std::string bytes;
    const std::vector<std::string> arrays = write_mesh_npz(mesh, to(bytes));
    files_.push_back({file, std::move(bytes)});
    for (int i = 0; i < mesh.count(); ++i) {
      source.channels.push_back({arrays[static_cast<std::size_t>(i)], std::nullopt, mesh[i].name});
    }
    return source;
  }

  std::vector<EmbeddedFile> take() { return std::move(files_); }

 private:
  Sink to(std::string& bytes) {
    return [this, &bytes](std::span<const std::byte> part) {
      total_ += part.size();
      if (total_ > most_bytes_) {
        throw TooManyBytes("not embedded: the data have more than " + std::to_string(most_bytes_) +
                           " bytes, also where they are compressed; make them smaller");
      }
      bytes.append(reinterpret_cast<const char*>(part.data()), part.size());
    };
  }

  /// Returns a plain name that no file has yet.
  std::string name_for(std::string name) {
    std::ranges::replace_if(
        name,
        [](char c) {
          const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
          return !is_letter && !(c >= '0' && c <= '9') && c != '-' && c != '_';
        },
        '_');
    name = name.substr(0, 60);
    if (name.empty()) name = "data";
    // Names that differ in capitals are one on some systems.
    std::string unique = name;
    for (int n = 2; !names_.insert(in_small_letters(unique)).second; ++n) {
      unique = name + "_" + std::to_string(n);
    }
    return unique + ".npz";
  }

  std::uint64_t most_bytes_, total_ = 0;
  const CoarserVolumes& coarser_;
  std::map<const std::byte*, std::string> file_of_;
  std::set<std::string> names_;
  std::vector<EmbeddedFile> files_;
};

/// Returns a name for the data of a field: that of its file, without what follows the first dot.
std::string name_of(const FieldSource& field, std::string_view other) {
  std::string name = field.file == array_in_memory ? "" : field.file.filename().string();
  name = name.substr(0, name.find('.'));
  return name.empty() ? std::string(other) : name;
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(where + ": not embedded: " + what);
}

void embed_mask(LayerDescription& layer, const VolumeContent& content, Files& files) {
  if (!layer.mask || !content.mask) return;
  FieldSource& field = layer.mask->field;
  field = files.add(content.mask->labels().volume(), name_of(field, "mask"), field);
}

void embed_channels(LayerDescription& layer, const Channels& channels, Files& files) {
  const auto volume_of = [&](const std::string& name) -> const Volume* {
    for (int i = 0; i < channels.count(); ++i) {
      if (channels[i].name == name) return channels[i].volume.get();
    }
    return nullptr;
  };
  if (layer.channels.empty()) {
    if (const Volume* const volume = volume_of(std::string(field_channel))) {
      layer.field = files.add(*volume, name_of(layer.field, "field"), layer.field);
    }
    return;
  }
  for (ChannelSource& channel : layer.channels) {
    auto* const field = std::get_if<FieldSource>(&channel.source);
    const Volume* const volume = volume_of(channel.name);
    if (field == nullptr || volume == nullptr) continue;
    *field = files.add(*volume, channel.name, *field);
  }
}

/// Puts the data of a layer into files, and has its description name those.
struct Embedding {
  LayerDescription& layer;
  Files& files;
  const std::string& where;

  void operator()(const VolumeContent& content) const {
    // A field that is built in is made where it is shown.
    if (layer.field.builtin.empty()) {
      layer.field = files.add(*content.volume, name_of(layer.field, "field"), layer.field);
    }
    embed_mask(layer, content, files);
  }
  void operator()(const ChannelsContent& content) const {
    if (layer.channels.empty() && !layer.field.builtin.empty()) return;
    embed_channels(layer, *content.channels, files);
  }
  void operator()(const LabelContent& content) const {
    LabelSource& labels = *layer.labels;
    labels.field =
        files.add(content.labels->volume(), name_of(labels.field, "labels"), labels.field);
    labels.styles = content.table->styles();
    labels.table.clear();
    labels.extinction.reset();
  }
  void operator()(const MeshContent& content) const {
    const std::string name = layer.mesh->file.filename().string();
    layer.mesh = files.add(*content.mesh, name.substr(0, name.find('.')));
  }
  void operator()(const SourceContent&) const {
    refuse(where, "it is a field of a program's own, which no file holds");
  }
};

}  // namespace

const std::byte* bytes_of(const Volume& volume) {
  return std::visit(
      [](const auto& values) { return reinterpret_cast<const std::byte*>(values.data()); },
      volume.data());
}

EmbeddedScene embed_scene(const SceneDescription& description, const Scene& scene,
                          std::uint64_t most_bytes) {
  return embed_coarser(description, scene, {}, most_bytes);
}

EmbeddedScene embed_coarser(const SceneDescription& description, const Scene& scene,
                            const CoarserVolumes& coarser, std::uint64_t most_bytes) {
  SceneDescription embedded = description;
  if (!embedded.backdrop.empty()) {
    refuse("backdrop", "pages have no pictures behind the data; leave it out");
  }
  Files files(most_bytes, coarser);
  for (std::size_t i = 0; i < embedded.layers.size(); ++i) {
    LayerDescription& layer = embedded.layers[i];
    const std::string where =
        layer.name.empty() ? "layer " + std::to_string(i + 1) : "layer \"" + layer.name + "\"";
    visit_sources(layer, [](FieldSource& field) { field.options.note = {}; });
    std::visit(Embedding{layer, files, where}, scene.layers[i].content);
  }
  return {scene_to_json(embedded), files.take()};
}

}  // namespace pellucid
