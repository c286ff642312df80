// SPDX-License-Identifier: Apache-2.0
#include "transport/endpoint/discovery.hpp"

#include <algorithm>

namespace warren::mesh {
namespace {

// A loss of this value says: I have not heard you for a while, say something.
constexpr std::uint8_t kMissed = 255;
// How long a member is searched for by fast beacons: then it will be the lone one, or with others.
constexpr Duration kSearch = std::chrono::seconds(10);
// Answers of many are spread: by so much per neighbour.
constexpr Duration kAnswerSpread = std::chrono::milliseconds(4);
constexpr Duration kAnswerSpreadMost = std::chrono::milliseconds(60);
// A beacon told with a shorter period is of someone who hears nobody: answers suffice for him.
constexpr Duration kLonePeriod = std::chrono::milliseconds(300);

// Uptimes are told in whole seconds.
constexpr Duration kLateBeacon = std::chrono::milliseconds(2500);
constexpr Duration kAskLate = std::chrono::seconds(1);

std::uint32_t low_half(BootId boot) { return static_cast<std::uint32_t>(boot.bits); }

}  // namespace

Discovery::Discovery(Node& node)
    : node_(node), group_key_(node.keys->group_key(node.config.boot)), clock_(node.jitter.bits()) {}

Peer* Discovery::on_beacon(MeshTime now, const PacketHeader& header, const MeshPath& from,
                           std::span<const std::uint8_t> packet) {
  Peer* peer = node_.members.find(header.sender);
  if (peer == nullptr && node_.members.is_retired(header.sender)) {
    node_.count(Unused::kRetiredBoot);
    return nullptr;
  }
  tl::expected<SessionKeys::Content, Unused> content = tl::unexpected(Unused::kNotAuthentic);
  if (peer != nullptr) {
    content = peer->session->keys.open(header, packet);
  } else if (auto opened = open(node_.keys->group_key(header.sender), packet)) {
    content = *std::move(opened);
  }
  if (!content) {
    node_.count(content.error());
    return nullptr;
  }
  const auto beacon = read_beacon(*content);
  if (!beacon) {
    node_.count(Unused::kMalformed);
    return nullptr;
  }
  if (beacon->member == node_.config.self) {
    node_.count(Unused::kOwnMember);
    return nullptr;
  }
  if (peer != nullptr) return on_session_beacon(now, *peer, *beacon, from);
  if (!node_.can_be_peer(beacon->member)) {
    node_.count(Unused::kMalformed);
    return nullptr;
  }
  on_unconfirmed_beacon(now, header, *beacon, from);
  return nullptr;
}

// A beacon that we missed and someone recorded is younger than the last one, but comes too late.
bool Discovery::is_late(MeshTime now, Session& session, const Beacon& beacon) {
  const MeshTime booted = now - std::chrono::seconds(beacon.uptime_s);
  if (session.booted && booted - *session.booted > kLateBeacon) return true;
  session.booted = booted;
  return false;
}

Peer* Discovery::on_session_beacon(MeshTime now, Peer& peer, const Beacon& beacon,
                                   const MeshPath& from) {
  if (is_late(now, *peer.session, beacon)) {
    // Or our clock was set, or its: the answer to a question will tell.
    node_.count(Unused::kNotFresh);
    if (!peer.answer && (peer.asked == MeshTime::min() || now - peer.asked > kAskLate)) {
      peer.asked = now;
      peer.answer = Peer::Answer{now, from, true, 1};
    }
    return &peer;
  }
  const Duration period = std::chrono::milliseconds(beacon.period_ms);
  peer.liveness.on_beacon(now, period, node_.members.size());
  peer.paths.on_beacon(now, from, period);
  for (const Beacon::Heard& heard : beacon.heard) {
    if (heard.boot != low_half(node_.config.boot)) continue;
    peer.liveness.on_hears_us(now);
    if (heard.loss_256th == kMissed) clock_.hurry(now);
  }
  peer.session->awaiting_since.reset();
  peer.session->flow.on_heard(now);
  node_.note_liveness(now, peer);
  const bool up = peer.liveness.up();
  if (!up) greet(now, beacon);
  // The address of a beacon proves nothing: the answer to this does.
  if ((!up || peer.paths.take_probe(now, from)) && !peer.answer) {
    peer.answer = Peer::Answer{now + answer_delay(now), from, true, Peer::kAskTries};
  }
  return &peer;
}

void Discovery::on_unconfirmed_beacon(MeshTime now, const PacketHeader& header,
                                      const Beacon& beacon, const MeshPath& from) {
  // A beacon may be recorded: nobody is forgotten for it yet.
  if (!node_.has_room_for(now, beacon.member)) {
    node_.count(Unused::kMemberTableFull);
    return;
  }
  using Verdict = UnconfirmedBoots::Verdict;
  UnconfirmedBoots::Boot told{header.sender, beacon.member, from};
  told.number = header.number;
  told.answer_at = now + answer_delay(now);
  const Verdict verdict = unconfirmed_.on_beacon(now, told);
  if (verdict == Verdict::kFirst) greet(now, beacon);
  if (verdict == Verdict::kReplayed) node_.count(Unused::kReplayed);
  if (verdict == Verdict::kTooMany) node_.count(Unused::kAnswerRateLimited);
}

void Discovery::challenge(MeshTime now, BootId boot, MemberId member, const MeshPath& from) {
  UnconfirmedBoots::Boot asked{boot, member, from};
  asked.answer_at = now;
  unconfirmed_.challenge(now, asked);
}

// Those around someone who appeared should hear us too.
void Discovery::greet(MeshTime now, const Beacon& beacon) {
  if (std::chrono::milliseconds(beacon.period_ms) > kLonePeriod) clock_.hurry(now);
}

Duration Discovery::answer_delay(MeshTime now) {
  const auto others = static_cast<Duration::rep>(neighbours(now));
  return node_.jitter.between({}, std::min(kAnswerSpreadMost, others * kAnswerSpread));
}

std::size_t Discovery::neighbours(MeshTime now) const {
  return static_cast<std::size_t>(
      std::count_if(node_.members.begin(), node_.members.end(), [&](const auto& member) {
        const Peer& peer = *member.second;
        return peer.session && !peer.liveness.overdue(now);
      }));
}

bool Discovery::misses_someone(MeshTime now) const {
  return std::any_of(node_.members.begin(), node_.members.end(), [&](const auto& member) {
    const Peer& peer = *member.second;
    return peer.session && peer.session->awaiting_since && peer.liveness.overdue(now) &&
           now - peer.liveness.heard() < kSearch;
  });
}

std::vector<Beacon::Heard> Discovery::heard_in_turn(MeshTime now) {
  std::vector<Beacon::Heard> heard;
  const auto tell = [&](MemberId least, MemberId most) {
    for (const auto& [id, peer] : node_.members) {
      if (id < least || most < id || heard.size() == Beacon::kHeardMax) continue;
      if (!peer->session || !peer->liveness.up()) continue;
      const double loss = peer->session->flow.quality().loss_in;
      const auto loss_256th = static_cast<std::uint8_t>(std::clamp(loss * 256.0, 0.0, 254.0));
      heard.push_back({low_half(peer->session->keys.peer()),
                       peer->liveness.overdue(now) ? kMissed : loss_256th});
      heard_turn_ = id;
    }
  };
  const MemberId last = heard_turn_;
  if (last.number != UINT32_MAX) tell({last.number + 1}, {UINT32_MAX});
  tell({0}, last);
  return heard;
}

void Discovery::send_round(MeshTime now) {
  Beacon beacon;
  beacon.member = node_.config.self;
  beacon.uptime_s = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::seconds>(now - *node_.started).count());
  beacon.heard = heard_in_turn(now);

  BeaconClock::Surroundings surroundings{neighbours(now), misses_someone(now), 0};
  const std::size_t packet_bytes = kEnvelopeBytes + encode(beacon).size() + 2;
  for (const InterfaceConfig& interface : node_.config.interfaces) {
    surroundings.round_bytes += (interface.group_copies + interface.seeds.size()) *
                                (interface.ip_header_bytes + packet_bytes);
  }
  const auto period =
      std::chrono::ceil<std::chrono::milliseconds>(BeaconClock::longest(surroundings));
  beacon.period_ms = static_cast<std::uint16_t>(
      std::min<std::chrono::milliseconds::rep>(period.count(), UINT16_MAX));
  const auto content = encode(beacon);
  for (std::size_t i = 0; i < node_.config.interfaces.size(); ++i) {
    const auto interface = static_cast<InterfaceIndex>(i);
    const auto packet =
        seal(group_key_, {PacketType::kBeacon, node_.config.boot, beacon_number_++}, content);
    round_.push_back({{interface, true, {}}, packet});
    for (const MeshAddress& seed : node_.config.interfaces[i].seeds) {
      round_.push_back({{interface, false, seed}, packet});
    }
  }
  clock_.on_sent(now, surroundings);
}

// Of a boot that is not confirmed: no session, a number never used before.
Datagram Discovery::hello(const UnconfirmedBoots::Boot& boot) {
  std::vector<std::uint8_t> content;
  append(content, HelloFrame{node_.config.self, true});
  return {boot.path,
          seal(node_.keys->pair_key(node_.config.boot, boot.boot),
               {PacketType::kPair, node_.config.boot, node_.free_pair_number++}, content)};
}

std::optional<Datagram> Discovery::poll(MeshTime now) {
  if (!node_.started) node_.started = now;
  if (round_.empty() && clock_.next() <= now) send_round(now);
  std::optional<Datagram> datagram;
  SentClass sent_class = SentClass::kBeacon;
  if (!round_.empty()) {
    datagram = std::move(round_.front());
    round_.pop_front();
  } else if (const auto boot = unconfirmed_.take_due(now)) {
    datagram = hello(*boot);
    sent_class = SentClass::kControl;
  } else {
    return std::nullopt;
  }
  const InterfaceIndex interface = datagram->to.interface;
  const std::size_t ip_bytes = node_.link_bytes(*datagram);
  node_.pacers[interface].on_sent(now, std::nullopt, ip_bytes, node_.paces(now, interface).slowest);
  node_.count_sent(ip_bytes);
  ++node_.counts[sent_class].packets;
  node_.counts[sent_class].bytes += datagram->bytes.size() - kEnvelopeBytes;
  return datagram;
}

MeshTime Discovery::next() const {
  if (!round_.empty()) return MeshTime::min();
  return std::min(clock_.next(), unconfirmed_.next());
}

std::size_t Discovery::memory_bytes() const {
  return sizeof(*this) + unconfirmed_.size() * sizeof(UnconfirmedBoots::Boot);
}

}  // namespace warren::mesh
