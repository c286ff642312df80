// SPDX-License-Identifier: Apache-2.0
#include "core/exchange/pcd_header.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/exchange/cloud_reader.hpp"
#include "core/exchange/text_fields.hpp"

namespace warren {
namespace {

// The lines of a header as they stand, one value per field.
struct RawHeader {
  std::vector<std::string_view> names, sizes, types, counts;
  std::optional<std::size_t> width, height, points;
  std::string_view encoding;
};

std::vector<std::string_view> split(std::string_view rest) {
  std::vector<std::string_view> fields;
  for (std::string_view field = take_field(rest); !field.empty(); field = take_field(rest)) {
    if (fields.size() > kMaxPcdFields) break;  // one too many is enough to be refused
    fields.push_back(field);
  }
  return fields;
}

// Takes one line; false when its value is no count though it must be.
bool read_entry(std::string_view entry, std::string_view values, RawHeader& raw) {
  std::string_view rest = values;
  const auto count = [&] { return to_count(take_field(rest)); };
  if (entry == "FIELDS" || entry == "COLUMNS") raw.names = split(values);
  if (entry == "SIZE") raw.sizes = split(values);
  if (entry == "TYPE") raw.types = split(values);
  if (entry == "COUNT") raw.counts = split(values);
  if (entry == "WIDTH") return (raw.width = count()).has_value();
  if (entry == "HEIGHT") return (raw.height = count()).has_value();
  if (entry == "POINTS") return (raw.points = count()).has_value();
  if (entry == "DATA") raw.encoding = take_field(rest);
  return true;
}

bool is_known(std::string_view entry) {
  constexpr std::array<std::string_view, 11> kEntries = {"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                         "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                         "VIEWPOINT", "POINTS", "DATA"};
  return std::find(kEntries.begin(), kEntries.end(), entry) != kEntries.end();
}

std::optional<PcdEncoding> encoding_of(std::string_view name) {
  if (name == "ascii") return PcdEncoding::kAscii;
  if (name == "binary") return PcdEncoding::kBinary;
  if (name == "binary_compressed") return PcdEncoding::kCompressed;
  return std::nullopt;
}

Decoded<PcdField> field_of(const RawHeader& raw, std::size_t index) {
  PcdField field;
  field.name = raw.names[index];
  const auto width = to_count(raw.sizes[index]);
  if (!width || (*width != 1 && *width != 2 && *width != 4 && *width != 8)) {
    return decode_error(0, "SIZE of field " + in_quotes(field.name) + " must be 1, 2, 4 or 8");
  }
  const std::string_view type = raw.types[index];
  if (type != "F" && type != "I" && type != "U") {
    return decode_error(0, "TYPE of field " + in_quotes(field.name) + " must be F, I or U");
  }
  const auto count = raw.counts.empty() ? 1 : to_count(raw.counts[index]);
  if (!count || *count == 0 || *count > kMaxPcdPointBytes) {
    return decode_error(0, "COUNT of field " + in_quotes(field.name) + " must be 1.." +
                               std::to_string(kMaxPcdPointBytes));
  }
  field.width = *width;
  field.type = type.front();
  field.count = *count;
  return field;
}

Decoded<void> add_fields(const RawHeader& raw, PcdHeader& header) {
  const std::size_t count = raw.names.size();
  if (count == 0 || count > kMaxPcdFields) return decode_error(0, "no usable FIELDS line");
  if (raw.sizes.size() != count || raw.types.size() != count ||
      (!raw.counts.empty() && raw.counts.size() != count)) {
    return decode_error(0, "FIELDS, SIZE, TYPE and COUNT differ in length");
  }
  for (std::size_t i = 0; i < count; ++i) {
    auto field = field_of(raw, i);
    if (!field) return tl::make_unexpected(field.error());
    header.point_bytes += field->bytes();
    header.fields.push_back(*std::move(field));
  }
  if (header.point_bytes <= kMaxPcdPointBytes) return {};
  return decode_error(0, "a point has more than " + std::to_string(kMaxPcdPointBytes) + " bytes");
}

Decoded<void> find_xyz(PcdHeader& header) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    const auto found = std::find_if(header.fields.begin(), header.fields.end(),
                                    [&](const PcdField& f) { return f.name == std::string{name}; });
    if (found == header.fields.end()) {
      return decode_error(0, std::string("has no field '") + name + "'");
    }
    if (found->type != 'F' || found->width < 4 || found->count != 1) {
      return decode_error(0, std::string("field '") + name + "' must be one float32 or float64");
    }
    header.xyz[axis] = static_cast<std::size_t>(found - header.fields.begin());
  }
  return {};
}

Decoded<void> count_points(const RawHeader& raw, PcdHeader& header) {
  if (!raw.points && !raw.width) return decode_error(0, "has neither POINTS nor WIDTH");
  const std::size_t width = raw.width ? *raw.width : *raw.points;
  const std::size_t height = raw.width ? raw.height.value_or(1) : 1;
  if (width > kMaxCloudPoints || height > kMaxCloudPoints || width * height > kMaxCloudPoints) {
    return decode_error(0, "more than " + std::to_string(kMaxCloudPoints) + " points");
  }
  header.points = width * height;
  if (raw.points.value_or(header.points) == header.points) return {};
  return decode_error(0, "POINTS is not WIDTH times HEIGHT");
}

Decoded<PcdHeader> check(const RawHeader& raw, PcdHeader header) {
  const auto encoding = encoding_of(raw.encoding);
  if (!encoding) {
    return decode_error(
        0, "DATA must be ascii, binary or binary_compressed, not " + in_quotes(raw.encoding));
  }
  header.encoding = *encoding;
  for (const auto& checked :
       {add_fields(raw, header), find_xyz(header), count_points(raw, header)}) {
    if (!checked) return tl::make_unexpected(checked.error());
  }
  return header;
}

}  // namespace

Decoded<PcdHeader> parse_pcd_header(std::string_view bytes) {
  RawHeader raw;
  LineReader lines(bytes);
  while (lines.line() < kMaxPcdHeaderLines) {
    const auto line = lines.next();
    if (!line) break;
    std::string_view rest = *line;
    const std::string_view entry = take_field(rest);
    if (entry.empty() || entry.front() == '#') continue;
    if (!is_known(entry)) {
      return decode_error(lines.line(), "no PCD header entry: " + in_quotes(entry));
    }
    if (!read_entry(entry, rest, raw)) {
      return decode_error(lines.line(), in_quotes(entry) + " needs a count");
    }
    if (entry != "DATA") continue;
    PcdHeader header;
    header.data_offset = lines.offset();
    header.data_line = lines.line() + 1;
    return check(raw, std::move(header));
  }
  return decode_error(0, "no PCD file: its header has no DATA line");
}

}  // namespace warren
