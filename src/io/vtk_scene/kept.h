// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace pellucid::vtk_scene {

/// Keeps the objects of the last picture by what they are made of, so that the renderer sees the
/// same object again and keeps its set-up. Recipes are compared by their values.
template <class Recipe, class Object>
class Kept {
 public:
  /// Returns the object of an equal recipe, or make(recipe): an object, or a pointer to one.
  template <class Make>
  std::shared_ptr<const Object> find(const Recipe& recipe, const Make& make) {
    for (Entry& entry : entries_) {
      if (entry.recipe == recipe) {
        entry.used = true;
        return entry.object;
      }
    }
    if constexpr (std::is_convertible_v<decltype(make(recipe)), std::shared_ptr<const Object>>) {
      entries_.push_back({recipe, make(recipe)});
    } else {
      entries_.push_back({recipe, std::make_shared<const Object>(make(recipe))});
    }
    ++made_;
    return entries_.back().object;
  }
  /// Forgets what was not asked for since the last call.
  void keep_used() {
    std::erase_if(entries_, [](const Entry& entry) { return !entry.used; });
    for (Entry& entry : entries_) entry.used = false;
  }
  /// Returns how many objects were made so far.
  int made() const noexcept { return made_; }

 private:
  struct Entry {
    Recipe recipe;
    std::shared_ptr<const Object> object;
    bool used = true;
  };
  std::vector<Entry> entries_;
  int made_ = 0;
};

}  // namespace pellucid::vtk_scene
