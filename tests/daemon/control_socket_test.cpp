// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <fstream>
#include <future>
#include <thread>

#include <doctest/doctest.h>

#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"
#include "proto/framing.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/running_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {
namespace {

control::Response save(const RunningDaemon& daemon, const std::string& path) {
  control::Request request;
  request.mutable_map_save()->set_path(path);
  return TestClient(daemon.control_socket()).ask(request);
}

void take_one_scan(const RunningDaemon& daemon, std::uint64_t sequence = 1) {
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(sequence, 1024)));
  REQUIRE(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
}

control::Request config_request() {
  control::Request request;
  request.mutable_config_print();
  return request;
}

void write_config(const RunningDaemon& daemon, const std::string& yaml) {
  std::ofstream(daemon.config_file()) << yaml;
}

// Collects what the service manager is told, for a thread that waits for it.
class Notifications {
 public:
  void add(const std::string& state) {
    const std::lock_guard lock(mutex_);
    states_.push_back(state);
    changed_.notify_all();
  }
  // Until one begins so, from `from` on; the index after it.
  std::size_t wait_for(const std::string& begin, std::size_t from = 0) {
    std::unique_lock lock(mutex_);
    for (;; ++from) {
      changed_.wait(lock, [&] { return states_.size() > from; });
      if (states_[from].rfind(begin, 0) == 0) return from + 1;
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> states_;
};

}  // namespace

TEST_CASE("the map is saved in every format") {
  RunningDaemon daemon;
  take_one_scan(daemon);
  for (const char* const ending : {"bt", "ot", "ply", "pcd", "png"}) {
    const std::filesystem::path file = daemon.file(std::string("map.") + ending);
    const auto response = save(daemon, file.string());
    REQUIRE_MESSAGE(response.has_map_saved(), response.error().text());
    CHECK(response.map_saved().format() == ending);
    CHECK(response.map_saved().bytes() == std::filesystem::file_size(file));
    CHECK(response.map_saved().voxels() > 0);
  }
}

TEST_CASE("a save that cannot be says why") {
  RunningDaemon daemon;
  CHECK(save(daemon, daemon.file("map.bt")).error().text().find("no map yet") != std::string::npos);
  take_one_scan(daemon);
  CHECK(save(daemon, "map.bt").error().text().find("absolute") != std::string::npos);
  CHECK(save(daemon, daemon.file("map.doc")).error().text().find(".bt") != std::string::npos);
  CHECK(save(daemon, "/nowhere/map.bt").error().text().find("/nowhere") != std::string::npos);
}

TEST_CASE("status answers while the mapping thread works, map info when it is free") {
  RunningDaemon daemon;
  control::Request request;
  request.mutable_map_info();
  TestClient client(daemon.control_socket());
  CHECK(client.ask(request).map_info().layers() == 0);
  take_one_scan(daemon);
  const auto info = client.ask(request).map_info();
  CHECK(info.scans() == 1);
  CHECK(info.layers() == 1);
  CHECK(info.origin_map_m_size() == 3);
  CHECK(info.high_map_m(0) >= 5.0);
  CHECK(info.t_fleet_map(6) == 1.0);
  const auto status = daemon.status();
  CHECK(status.node() == "robot");
  CHECK(status.queue_capacity() == 8);
  CHECK(status.integrate_cpu_ms_max() > 0.0);
}

TEST_CASE("the config in force is printed and loads back equal") {
  RunningDaemon daemon;
  const auto yaml = TestClient(daemon.control_socket()).ask(config_request()).config().yaml();
  const auto config = parse_config(yaml, "printed");
  REQUIRE(config.has_value());
  CHECK(*config == daemon.config());
}

TEST_CASE("garbage on the control socket is answered by an error and harms nobody") {
  RunningDaemon daemon;
  TestClient client(daemon.control_socket());
  for (const std::string& garbage : {std::string("\xFF\xFF"), std::string("\x7A\x00", 2)}) {
    REQUIRE(client.write(framed(garbage)));
    control::Response response;
    REQUIRE(response.ParseFromString(client.read_frame().value()));
    CHECK_FALSE(response.error().text().empty());
  }
  REQUIRE(client.write("GET / HTTP/1.1\r\n\r\n"));
  CHECK(client.read_frame().has_value());
  CHECK(client.is_at_end());
  TestClient(daemon.control_socket()).write("\x10");
  CHECK(daemon.status().node() == "robot");
}

TEST_CASE("one control client too many is told so") {
  RunningDaemon daemon;
  std::vector<std::unique_ptr<TestClient>> clients;
  for (std::size_t i = 0; i < ControlServer::kMaxClients; ++i) {
    clients.push_back(std::make_unique<TestClient>(daemon.control_socket()));
    CHECK(clients.back()->ask(config_request()).has_config());
  }
  TestClient last(daemon.control_socket());
  control::Response response;
  REQUIRE(response.ParseFromString(last.read_frame().value()));
  CHECK(response.error().text().find("too many") != std::string::npos);
  CHECK(last.is_at_end());
}

TEST_CASE(
    "a reload takes over sensors and queue, keeps the rest, and a faulty file changes nothing") {
  Notifications notifications;
  Warrend::Dependencies dependencies{save_map};
  dependencies.notify = [&](const std::string& state) { notifications.add(state); };
  RunningDaemon daemon({}, dependencies);
  std::size_t seen = notifications.wait_for("READY=1");

  Config wanted = daemon.config();
  wanted.ingest.queue_scans = 2;
  wanted.map.resolution_m = 0.5;
  wanted.sensors.front().name = "top";
  write_config(daemon, print_config(wanted));
  daemon.request_reload();
  seen = notifications.wait_for("RELOADING=1", seen);
  seen = notifications.wait_for("READY=1", seen);
  TestClient client(daemon.ingest_socket());
  client.write(hello_frame());
  const auto welcome = client.read_reply()->welcome();
  CHECK(welcome.sensors(0) == "top");
  CHECK(welcome.queue_scans() == 2);
  CHECK(daemon.status().queue_capacity() == 2);
  CHECK(daemon.status().map().resolution_m() == 0.1);

  write_config(daemon, "sensors: 5\n");
  daemon.request_reload();
  seen = notifications.wait_for("RELOADING=1", seen);
  notifications.wait_for("READY=1\nSTATUS=Mapping; the config file has faults", seen);
  CHECK(daemon.status().sensors_size() == 2);  // the old one's counts stay
  client.write(framed([] {
    auto request = scan_request(1, 0);
    request.mutable_scan()->set_sensor("top");
    return request.SerializeAsString();
  }()));
  CHECK(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
}

TEST_CASE("the watchdog is fed while the mapping thread is free and not while it hangs") {
  Notifications notifications;
  std::atomic<int> fed{0};
  Warrend::Dependencies dependencies{save_map};
  dependencies.watchdog_time = std::chrono::milliseconds(8);
  dependencies.notify = [&](const std::string& state) {
    if (state == "WATCHDOG=1") ++fed;
    notifications.add(state);
  };
  RunningDaemon daemon({}, dependencies);
  std::size_t seen = 0;
  for (int i = 0; i < 3; ++i) seen = notifications.wait_for("WATCHDOG=1", seen);

  daemon.gate().shut();
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(1)));
  daemon.gate().wait_until_somebody_waits();
  // Many ticks pass here: each question is answered by the io thread, some after a tick.
  TestClient asker(daemon.control_socket());
  const int before = fed;
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(100)) {
    CHECK(asker.ask(config_request()).has_config());
  }
  CHECK(fed <= before + 1);  // a beat that was on its way
  daemon.gate().open();
  CHECK(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
  notifications.wait_for("WATCHDOG=1", seen);
}

TEST_CASE("the watchdog is not fed while a file takes far too long") {
  std::atomic<int> fed{0};
  std::promise<void> disk;
  const std::shared_future<void> disk_answers(disk.get_future());
  Warrend::Dependencies dependencies{[&](const MapSnapshot&, const std::filesystem::path&,
                                         PictureColours) -> tl::expected<SaveReport, std::string> {
    disk_answers.wait();
    return SaveReport{};
  }};
  dependencies.watchdog_time = std::chrono::milliseconds(8);
  dependencies.file_time_max = std::chrono::milliseconds(200);
  dependencies.notify = [&](const std::string& state) { fed += state == "WATCHDOG=1" ? 1 : 0; };
  RunningDaemon daemon({}, dependencies);
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(1)));
  REQUIRE(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
  TestClient saver(daemon.control_socket());
  REQUIRE(saver.write(framed([&] {
    control::Request save;
    save.mutable_map_save()->set_path(daemon.file("map.bt").string());
    return save.SerializeAsString();
  }())));
  const auto feeds_in = [&](std::chrono::milliseconds time) {
    const int before = fed;
    std::this_thread::sleep_for(time);
    return fed - before;
  };
  int starved = 0;
  for (int i = 0; i < 100 && starved < 3; ++i) {
    starved = feeds_in(std::chrono::milliseconds(100)) == 0 ? starved + 1 : 0;
  }
  CHECK(starved == 3);
  CHECK(daemon.status().queue_capacity() > 0);  // all other threads answer
  disk.set_value();
  int again = 0;
  for (int i = 0; i < 100 && again == 0; ++i) again = feeds_in(std::chrono::milliseconds(100));
  CHECK(again > 0);
}

TEST_CASE("a stop integrates what has arrived and answers it before it closes") {
  RunningDaemon daemon;
  daemon.gate().shut();
  TestClient client = greeted_client(daemon.ingest_socket());
  for (std::uint64_t i = 1; i <= 5; ++i) REQUIRE(client.write(scan_frame(i)));
  REQUIRE(client.write(scan_frame(6).substr(0, 100)));
  TestClient killed = greeted_client(daemon.ingest_socket());
  killed.close();
  daemon.gate().wait_until_somebody_waits();
  daemon.request_stop();
  daemon.gate().open();
  for (std::uint64_t i = 1; i <= 5; ++i) {
    const auto receipt = client.read_receipt();
    CHECK(receipt.sequence() == i);
    CHECK(receipt.outcome() == ingest::ScanReceipt::TAKEN);
  }
  CHECK(client.is_at_end());
  daemon.join();
}

}  // namespace warren
