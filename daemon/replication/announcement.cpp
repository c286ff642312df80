// SPDX-License-Identifier: Apache-2.0
#include "daemon/replication/announcement.hpp"

#include "daemon/replication/layer_wire.hpp"

namespace warren::replication {

std::vector<std::uint8_t> encode(const Announcement& announcement) {
  std::vector<std::uint8_t> bytes;
  mesh::PacketWriter writer(bytes);
  writer.byte(Announcement::kKind);
  write(writer, announcement.layer);
  writer.number(announcement.resolution.micrometres());
  writer.byte(announcement.hops);
  writer.number(announcement.provider ? std::uint64_t{announcement.provider->number} + 1 : 0);
  write(writer, announcement.holdings);
  if (announcement.digest) writer.fixed(*announcement.digest, 8);
  return bytes;
}

std::optional<Announcement> read_announcement(std::span<const std::uint8_t> bytes) {
  mesh::PacketReader reader(bytes);
  if (reader.fixed(1) != Announcement::kKind) return std::nullopt;
  const auto layer = read_layer_id(reader);
  const auto micrometres = layer ? reader.number(Resolution::kMaximum_um) : std::nullopt;
  const auto hops = micrometres ? reader.fixed(1) : std::nullopt;
  const auto provider = hops ? reader.number(std::uint64_t{UINT32_MAX} + 1) : std::nullopt;
  if (!provider || *hops > kNoWay) return std::nullopt;
  const auto resolution = Resolution::from_micrometres(static_cast<std::uint32_t>(*micrometres));
  auto holdings = read_holdings(reader);
  if (!resolution || !holdings) return std::nullopt;
  Announcement read{*layer,       *resolution,          static_cast<Hops>(*hops),
                    std::nullopt, std::move(*holdings), std::nullopt};
  if (*provider > 0) read.provider = MemberId{static_cast<std::uint32_t>(*provider - 1)};
  if (reader.at_end()) return read;
  read.digest = reader.fixed(8);
  const bool is_whole = read.holdings.intervals().size() == 1;
  return read.digest && reader.at_end() && is_whole ? std::optional(read) : std::nullopt;
}

}  // namespace warren::replication
