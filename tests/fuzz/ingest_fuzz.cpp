// SPDX-License-Identifier: Apache-2.0
// One client's stream: messages, refusal and state are the same however the stream is cut, and a
// scan never holds more than what came.
#include <algorithm>
#include <cassert>
#include <cstring>
#include <random>

#include "daemon/ingest/decoder.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace warren::fuzz {
namespace {

// As much as fits in the longest input of tools/test.
const IngestLimits kLimits{5000, {"lidar", "rear"}};

// All that a decoder told, as bytes: NaN equals itself there.
struct Transcript {
  std::string text;

  template <typename T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void add(const std::string& value) {
    add(value.size());
    text.append(value);
  }
  void add(const Eigen::Vector3d& v) {
    std::for_each_n(v.data(), 3, [&](double x) { add(x); });
  }
  void add(const Pose& pose) {
    add(pose.translation);
    std::for_each_n(pose.rotation.coeffs().data(), 4, [&](double x) { add(x); });
  }
  void add(const std::vector<Point3f>& points) {
    add(points.size());
    for (const Point3f& point : points) add(point);
  }

  void operator()(const HelloMessage& message) {
    add(message.protocol_version);
    add(message.client);
  }
  void operator()(const PoseUpdateMessage& message) {
    add(message.frame_epoch);
    add(message.T_fleet_map);
  }
  void operator()(const ScanMessage& message) {
    add(message.sequence);
    add(message.sensor);
    add(message.frame_epoch);
    add(message.stamp_ns);
    add(message.scan.T_map_base);
    add(message.scan.T_base_sensor);
    add(message.scan.gravity_map);
    add(message.scan.points_sensor);
    add(message.scan.no_return_directions_sensor);
  }
};

void check_size(const IngestMessage& message, std::size_t bytes_used) {
  const auto* const message_of_scan = std::get_if<ScanMessage>(&message);
  if (message_of_scan == nullptr) return;
  const Scan& scan = message_of_scan->scan;
  const std::size_t points = scan.points_sensor.size() + scan.no_return_directions_sensor.size();
  assert(points <= kLimits.max_points && points * kPointBytes <= bytes_used);
}

// `next_piece` says how many bytes the next read brings, at most.
template <typename NextPiece>
std::string transcript_of(std::span<const std::byte> stream, NextPiece next_piece) {
  IngestDecoder decoder;
  Transcript transcript;
  std::size_t used = 0;
  while (used < stream.size()) {
    const auto buffer = decoder.buffer();
    assert(!buffer.empty() && buffer.size() <= IngestDecoder::kChunkBytes);
    const std::size_t count = std::min({buffer.size(), next_piece(), stream.size() - used});
    std::memcpy(buffer.data(), stream.data() + used, count);
    used += count;
    const auto message = decoder.commit(count, kLimits);
    if (!message) {
      assert(!message.error().text.empty());
      transcript.add(message.error().refusal);
      transcript.add(message.error().text);
      break;
    }
    if (!message->has_value()) continue;
    check_size(**message, used);
    std::visit(transcript, **message);
  }
  transcript.add(used);
  transcript.add(decoder.is_within_message());
  return transcript.text;
}

}  // namespace
}  // namespace warren::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace warren::fuzz;
  warren::silence_protobuf();
  const auto stream = bytes_of(data, size);
  const std::string whole = transcript_of(stream, [&] { return size; });
  assert(whole == transcript_of(stream, [] { return std::size_t{1}; }));
  std::minstd_rand random(static_cast<unsigned>(size));
  assert(whole == transcript_of(stream, [&] { return std::size_t{1} + random() % 40; }));
  return 0;
}
