// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// Classic files of NetCDF written by the format's description, by nothing that the library reads
// them with.
namespace pellucid::test {

/// Numbers and text of a classic file: big-endian, padded to four bytes.
class ClassicBytes {
 public:
  ClassicBytes& number(std::uint32_t n) {
    append(n, 4);
    return *this;
  }
  ClassicBytes& text(const std::string& name) {
    number(static_cast<std::uint32_t>(name.size()));
    bytes += name;
    return pad();
  }
  /// Types are those of Python's struct: b, h, i, f, d.
  ClassicBytes& values(char type, const std::vector<double>& list) {
    for (const double value : list) {
      if (type == 'd') {
        append(std::bit_cast<std::uint64_t>(value), 8);
      } else if (type == 'f') {
        append(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
      } else {
        append(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), type == 'b'   ? 1
                                                                             : type == 'h' ? 2
                                                                                           : 4);
      }
    }
    return pad();
  }
  ClassicBytes& pad() {
    while (bytes.size() % 4 != 0) bytes += '\0';
    return *this;
  }
  std::string bytes;

 private:
  void append(std::uint64_t n, int count) {
    for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) {
      bytes += static_cast<char>(n >> shift & 255U);
    }
  }
};

inline std::uint32_t classic_type(char type) {
  return type == 'b' ? 1 : type == 'h' ? 3 : type == 'i' ? 4 : type == 'f' ? 5 : 6;
}

/// An attribute: text, or numbers of a type.
struct ClassicAttribute {
  std::string name, text;
  char type = '\0';
  std::vector<double> numbers;

  ClassicAttribute(std::string n, std::string t) : name(std::move(n)), text(std::move(t)) {}
  ClassicAttribute(std::string n, const char* t) : name(std::move(n)), text(t) {}
  ClassicAttribute(std::string n, char t, std::vector<double> list)
      : name(std::move(n)), type(t), numbers(std::move(list)) {}
};

struct ClassicVariable {
  std::string name;
  char type = 'f';
  std::vector<std::string> axes;
  std::vector<double> values;
  std::vector<ClassicAttribute> attributes = {};
};

struct ClassicFile {
  std::vector<std::pair<std::string, int>> axes;  ///< 0: unlimited, without records
  std::vector<ClassicVariable> variables;

  std::string bytes() const {
    std::vector<std::uint32_t> begins;
    auto at =
        static_cast<std::uint32_t>(header(std::vector<std::uint32_t>(variables.size())).size());
    std::string data;
    for (const ClassicVariable& variable : variables) {
      begins.push_back(at + static_cast<std::uint32_t>(data.size()));
      data += ClassicBytes().values(variable.type, variable.values).bytes;
    }
    return header(begins) + data;
  }

 private:
  std::string header(const std::vector<std::uint32_t>& begins) const {
    ClassicBytes file;
    file.bytes = std::string("CDF\1", 4);
    file.number(0).number(10).number(static_cast<std::uint32_t>(axes.size()));
    for (const auto& [name, side] : axes) file.text(name).number(static_cast<std::uint32_t>(side));
    file.number(0).number(0).number(11).number(static_cast<std::uint32_t>(variables.size()));
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const ClassicVariable& variable = variables[v];
      file.text(variable.name).number(static_cast<std::uint32_t>(variable.axes.size()));
      for (const std::string& axis : variable.axes) {
        std::uint32_t place = 0;
        while (axes[place].first != axis) ++place;
        file.number(place);
      }
      const auto count = static_cast<std::uint32_t>(variable.attributes.size());
      file.number(count > 0 ? 12 : 0).number(count);
      for (const ClassicAttribute& attribute : variable.attributes) add(attribute, file);
      const auto size = ClassicBytes().values(variable.type, variable.values).bytes.size();
      file.number(classic_type(variable.type)).number(static_cast<std::uint32_t>(size));
      file.number(begins[v]);
    }
    return file.bytes;
  }
  static void add(const ClassicAttribute& attribute, ClassicBytes& file) {
    file.text(attribute.name);
    if (attribute.type == '\0') {
      file.number(2).text(attribute.text);
      return;
    }
    file.number(classic_type(attribute.type));
    file.number(static_cast<std::uint32_t>(attribute.numbers.size()));
    file.values(attribute.type, attribute.numbers);
  }
};

}  // namespace pellucid::test
