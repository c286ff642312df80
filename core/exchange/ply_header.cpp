// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/ply_header.hpp"

#include <algorithm>
#include <optional>

#include "core/exchange/cloud_reader.hpp"
#include "core/exchange/text_fields.hpp"

namespace warren {
namespace {

struct ScalarType {
  std::string_view name;
  std::size_t width;
  bool is_float;
};
constexpr std::array<ScalarType, 16> kScalarTypes = {{{"char", 1, false},
                                                      {"int8", 1, false},
                                                      {"uchar", 1, false},
                                                      {"uint8", 1, false},
                                                      {"short", 2, false},
                                                      {"int16", 2, false},
                                                      {"ushort", 2, false},
                                                      {"uint16", 2, false},
                                                      {"int", 4, false},
                                                      {"int32", 4, false},
                                                      {"uint", 4, false},
                                                      {"uint32", 4, false},
                                                      {"float", 4, true},
                                                      {"float32", 4, true},
                                                      {"double", 8, true},
                                                      {"float64", 8, true}}};

// Takes the lines of a header one by one. Each step returns a fault, empty if there is none.
class PlyHeaderParser {
 public:
  std::string take(std::string_view line) {
    std::string_view rest = line;
    const std::string_view entry = take_field(rest);
    if (entry == "format") return take_format(rest);
    if (entry == "element") return take_element(rest);
    if (entry == "property") return elements_ == 1 ? take_property(rest) : "";
    if (entry == "comment" || entry == "obj_info" || entry.empty()) return {};
    return "no PLY header entry: " + in_quotes(entry);
  }

  Decoded<PlyHeader> finish() const {
    if (!has_format_) return decode_error(0, "its header has no format line");
    if (elements_ == 0) return decode_error(0, "its header has no element vertex");
    if (!found_[0] || !found_[1] || !found_[2]) {
      return decode_error(0, "its vertices have no x, y and z of type float or double");
    }
    return header_;
  }

 private:
  std::string take_format(std::string_view rest) {
    const std::string_view name = take_field(rest);
    has_format_ = true;
    header_.ascii = name == "ascii";
    if (header_.ascii || name == "binary_little_endian") return {};
    return "format must be ascii or binary_little_endian, not " + in_quotes(name);
  }

  std::string take_element(std::string_view rest) {
    if (++elements_ > 1) return {};  // what follows the vertices is not read
    const std::string_view name = take_field(rest);
    if (name != "vertex") return "the first element must be vertex, not " + in_quotes(name);
    const auto count = to_count(take_field(rest));
    if (!count || *count > kMaxCloudPoints) {
      return "needs a vertex count of at most " + std::to_string(kMaxCloudPoints);
    }
    header_.vertices = *count;
    return {};
  }

  std::string take_property(std::string_view rest) {
    const std::string_view type_name = take_field(rest);
    const std::string_view name = take_field(rest);
    const auto* const type = std::find_if(kScalarTypes.begin(), kScalarTypes.end(),
                                          [&](const auto& t) { return t.name == type_name; });
    if (type == kScalarTypes.end()) {
      return "a vertex property must be a scalar, not " + in_quotes(type_name);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (name.size() != 1 || name[0] != "xyz"[axis] || !type->is_float) continue;
      header_.xyz[axis] = {header_.columns, header_.vertex_bytes, type->width};
      found_[axis] = true;
    }
    ++header_.columns;
    header_.vertex_bytes += type->width;
    return header_.vertex_bytes <= kMaxPlyPointBytes ? "" : "too many vertex properties";
  }

  PlyHeader header_;
  bool has_format_ = false;
  std::size_t elements_ = 0;
  std::array<bool, 3> found_{};
};

}  // namespace

Decoded<PlyHeader> parse_ply_header(std::string_view bytes) {
  LineReader lines(bytes);
  if (lines.next() != "ply") return decode_error(1, "no PLY file: it does not begin with 'ply'");
  PlyHeaderParser parser;
  while (lines.line() < kMaxPlyHeaderLines) {
    const auto line = lines.next();
    if (!line) break;
    if (*line == "end_header") {
      auto header = parser.finish();
      if (!header) return header;
      header->data_offset = lines.offset();
      header->data_line = lines.line() + 1;
      return header;
    }
    const std::string fault = parser.take(*line);
    if (!fault.empty()) return decode_error(lines.line(), fault);
  }
  return decode_error(0, "its header has no end_header line");
}

}  // namespace warren
