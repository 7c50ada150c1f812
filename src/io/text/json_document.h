// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pellucid::scene_json {

/// Numbers of a scene lie in ±largest_number: float holds them, and their products with lengths up
/// to 1e8.
constexpr double largest_number = 1e30;
/// Data values, and what is compared with them, lie in ±largest_value: what a Volume takes.
constexpr double largest_value = 2.1e37;

/// Returns a number as messages have it.
std::string number_text(double number);

/// Levels of nesting that a scene may have.
constexpr std::size_t deepest_scene = 16;

/// Parses strict JSON. Beyond what the grammar asks: no key twice in one object, no more than
/// `deepest` levels of nesting, no number beyond double's range. Throws Error with line and column.
nlohmann::json parse_document(std::string_view text, const std::string& name,
                              std::size_t deepest = deepest_scene);

/// A value in the document together with its place, so that every message names both.
class Node {
 public:
  Node(const nlohmann::json& value, std::string name) : value_(&value), name_(std::move(name)) {}

  /// Throws Error: "name: pointer: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// Fails likewise about a key of this object, whether it is there or not.
  [[noreturn]] void fail_at(std::string_view key, const std::string& what) const;

  /// Fails unless this is an object that has no keys but these.
  void expect_object(const std::vector<std::string_view>& known_keys) const;
  bool is_object() const noexcept;
  bool is_array() const noexcept;
  bool is_string() const noexcept;
  bool is_number() const noexcept;
  bool is_null() const noexcept;
  const nlohmann::json& value() const noexcept { return *value_; }
  /// Returns whether this is true, or a number that is not 0, as other programs write it.
  bool is_true() const;
  bool has(std::string_view key) const;
  /// Returns the value of a key of this object; none where it is absent.
  std::optional<Node> find(std::string_view key) const;
  /// Returns the same, but fails with the hint where it is absent.
  Node at(std::string_view key, const std::string& hint) const;

  /// Fails unless this is an array; its length, and its elements.
  std::size_t array_size() const;
  Node element(std::size_t index) const;

  /// Fails unless this is a number in [lower, upper].
  double number(double lower = -largest_number, double upper = largest_number) const;
  /// Fails unless this is a number in (0, upper].
  double positive_number(double upper = largest_number) const;
  /// Fails unless this is a number in (lower, upper).
  double number_between(double lower, double upper) const;
  /// Fails unless this is a number without a fraction (2 or 2.0) in [lower, upper].
  long long integer(long long lower, long long upper) const;
  bool boolean() const;
  const std::string& string() const;
  /// Returns the index of the string among the words; fails for another.
  std::size_t one_of(const std::vector<std::string_view>& words) const;

  const std::string& pointer() const noexcept { return pointer_; }
  /// Returns the beginning of messages: "name: pointer".
  std::string where() const;

 private:
  Node child(const nlohmann::json& value, std::string_view token) const;
  std::string found() const;

  const nlohmann::json* value_;
  std::string name_, pointer_;
};

}  // namespace pellucid::scene_json
