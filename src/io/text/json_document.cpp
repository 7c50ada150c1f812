// SPDX-License-Identifier: Apache-2.0
#include "json_document.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"
#include "printable.h"

namespace pellucid::scene_json {
namespace {

using nlohmann::json;

/// Returns a token of a JSON pointer (RFC 6901), fit for a message.
std::string pointer_token(std::string_view key) {
  std::string escaped;
  for (const char c : key) {
    escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  }
  return printable(escaped);
}

/// Builds the document event by event, since the ready-made parser keeps the last of two equal keys
/// and recurses over any depth when the document is destroyed.
class Builder : public nlohmann::json_sax<json> {
 public:
  Builder(std::string_view text, const std::string& name, std::size_t deepest)
      : text_(text), name_(name), deepest_(deepest) {}

  json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return add(nullptr); }
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    if (open_.back()->contains(key)) {
      throw Error(name_ + ": " + pointer() + "/" + pointer_token(key) +
                  ": stands twice; keep one of them");
    }
    key_ = key;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    // `position` counts the bytes read, the offending one (or the end of the text) included.
    const std::size_t end = std::min(position, text_.size() + 1);
    const std::string_view before = text_.substr(0, end > 0 ? end - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    std::string what = error.what();
    if (const std::size_t bracket = what.find("] "); bracket != std::string::npos) {
      what.erase(0, bracket + 2);
    }
    if (what.rfind("parse error", 0) == 0) {
      if (const std::size_t colon = what.find(": "); colon != std::string::npos) {
        what.erase(0, colon + 2);
      }
    }
    constexpr int number_overflow = 406;
    throw Error(name_ + ": line " + std::to_string(line) + ", column " +
                std::to_string(before.size() - line_start + 1) + ": " +
                (error.id == number_overflow ? "" : "not valid JSON: ") + printable(what));
  }

 private:
  json* put(json&& value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[key_] = std::move(value));
  }
  bool add(json&& value) {
    put(std::move(value));
    return true;
  }
  bool open(json&& value) {
    if (open_.size() == deepest_) {
      throw Error(name_ + ": " + printable(pointer()) + ": nested deeper than " +
                  std::to_string(deepest_) + " levels" +
                  (deepest_ == deepest_scene ? "; a scene needs 10" : ""));
    }
    const bool in_array = !open_.empty() && open_.back()->is_array();
    const std::string token = in_array ? std::to_string(open_.back()->size()) : pointer_token(key_);
    if (!open_.empty()) tokens_.push_back(token);
    // The parent cannot grow while its child is open: the pointer stays valid.
    open_.push_back(put(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    if (!tokens_.empty()) tokens_.pop_back();
    return true;
  }
  std::string pointer() const {
    std::string path;
    for (const std::string& token : tokens_) path += "/" + token;
    return path;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t deepest_;
  json root_;
  std::vector<json*> open_;
  std::vector<std::string> tokens_;
  std::string key_;
};

std::string list(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) {
    text += (text.empty() ? "\"" : ", \"") + std::string(word) + "\"";
  }
  return text;
}

}  // namespace

std::string number_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", number);
  return text;
}

json parse_document(std::string_view text, const std::string& name, std::size_t deepest) {
  Builder builder(text, name, deepest);
  json::sax_parse(text.begin(), text.end(), &builder);
  return builder.take();
}

std::string Node::where() const {
  return name_ + (pointer_.empty() ? "" : ": " + pointer_);
}

void Node::fail(const std::string& what) const {
  throw Error(where() + ": " + what);
}

void Node::fail_at(std::string_view key, const std::string& what) const {
  throw Error(name_ + ": " + pointer_ + "/" + pointer_token(key) + ": " + what);
}

std::string Node::found() const {
  if (value_->is_null()) return "null";
  if (value_->is_boolean()) return value_->get<bool>() ? "true" : "false";
  if (value_->is_number()) return number_text(value_->get<double>());
  if (value_->is_string()) {
    return "the string \"" + printable(value_->get_ref<const std::string&>()) + "\"";
  }
  return value_->is_array() ? "an array" : "an object";
}

Node Node::child(const json& value, std::string_view token) const {
  Node node(value, name_);
  node.pointer_ = pointer_ + "/" + pointer_token(token);
  return node;
}

void Node::expect_object(const std::vector<std::string_view>& known_keys) const {
  if (!value_->is_object()) fail("must be an object, but is " + found());
  for (const auto& item : value_->items()) {
    if (std::find(known_keys.begin(), known_keys.end(), item.key()) == known_keys.end()) {
      const std::string hint = did_you_mean(item.key(), known_keys);
      fail_at(item.key(),
              "unknown key" + (hint.empty() ? "; known here: " + list(known_keys) : hint));
    }
  }
}

bool Node::is_object() const noexcept {
  return value_->is_object();
}

bool Node::is_array() const noexcept {
  return value_->is_array();
}

bool Node::is_string() const noexcept {
  return value_->is_string();
}

bool Node::is_number() const noexcept {
  return value_->is_number();
}

bool Node::is_null() const noexcept {
  return value_->is_null();
}

bool Node::is_true() const {
  if (value_->is_number()) return value_->get<double>() != 0;
  return value_->is_boolean() && value_->get<bool>();
}

bool Node::has(std::string_view key) const {
  return value_->contains(key);
}

std::optional<Node> Node::find(std::string_view key) const {
  const auto item = value_->find(key);
  if (item == value_->end()) return std::nullopt;
  return child(*item, key);
}

Node Node::at(std::string_view key, const std::string& hint) const {
  if (!has(key)) fail_at(key, "is missing; " + hint);
  return *find(key);
}

std::size_t Node::array_size() const {
  if (!value_->is_array()) fail("must be an array, but is " + found());
  return value_->size();
}

Node Node::element(std::size_t index) const {
  return child((*value_)[index], std::to_string(index));
}

double Node::number(double lower, double upper) const {
  if (!value_->is_number()) fail("must be a number, but is " + found());
  const auto number = value_->get<double>();
  if (!(number >= lower && number <= upper)) {
    fail("is " + found() + ", but must be " + number_text(lower) + " to " + number_text(upper));
  }
  return number;
}

double Node::positive_number(double upper) const {
  const double value = number(-largest_number, largest_number);
  if (!(value > 0 && value <= upper)) {
    fail("is " + found() + ", but must be above 0 and at most " + number_text(upper));
  }
  return value;
}

double Node::number_between(double lower, double upper) const {
  const double value = number(-largest_number, largest_number);
  if (!(value > lower && value < upper)) {
    fail("is " + found() + ", but must be above " + number_text(lower) + " and below " +
         number_text(upper));
  }
  return value;
}

long long Node::integer(long long lower, long long upper) const {
  if (!value_->is_number() || value_->get<double>() != std::floor(value_->get<double>())) {
    fail("must be an integer, but is " + found());
  }
  // The bounds are far below 2⁵³, so the comparison in double is exact.
  return static_cast<long long>(number(static_cast<double>(lower), static_cast<double>(upper)));
}

bool Node::boolean() const {
  if (!value_->is_boolean()) fail("must be true or false, but is " + found());
  return value_->get<bool>();
}

const std::string& Node::string() const {
  if (!value_->is_string()) fail("must be a string, but is " + found());
  return value_->get_ref<const std::string&>();
}

std::size_t Node::one_of(const std::vector<std::string_view>& words) const {
  const auto word = std::find(words.begin(), words.end(), string());
  if (word == words.end()) {
    fail("is \"" + printable(string()) + "\"" + did_you_mean(string(), words) +
         ", but must be one of " + list(words));
  }
  return static_cast<std::size_t>(word - words.begin());
}

}  // namespace pellucid::scene_json
