// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <limits>

#include <doctest/doctest.h>

#include "core/exchange/layer_file.hpp"
#include "core/layer/hash_text.hpp"
#include "tests/daemon/frames.hpp"
#include "tests/daemon/mapped_daemon.hpp"
#include "tests/daemon/test_client.hpp"

namespace warren {
namespace {

void take_one_scan(const RunningDaemon& daemon) {
  TestClient client = greeted_client(daemon.ingest_socket());
  REQUIRE(client.write(scan_frame(1, 1024)));
  REQUIRE(client.read_receipt().outcome() == ingest::ScanReceipt::TAKEN);
}

// Asks until a tick has published something: bounded by the client's patience.
control::Publishing first_published(const RunningDaemon& daemon) {
  for (int asked = 0; asked < 100'000; ++asked) {
    control::Publishing now = daemon.status().publishing();
    if (now.revision() > 0) return now;
  }
  FAIL("nothing was published");
  return {};
}

// Asks until the scan's tick and the flush after it have been: bounded by the client's patience.
control::Publishing published(const RunningDaemon& daemon) {
  for (int asked = 0; asked < 100'000; ++asked) {
    control::Publishing now = daemon.status().publishing();
    if (now.revision() > 0 && now.blocks_held_back() == 0) return now;
  }
  FAIL("nothing was published");
  return {};
}

control::Request load_request(const std::string& path) {
  control::Request request;
  request.mutable_map_load()->set_path(path);
  return request;
}

}  // namespace

TEST_CASE("a follower's copy and a saved layer have the digest that the daemon tells") {
  RunningDaemon daemon(quick_ticks());
  take_one_scan(daemon);
  const control::Publishing publishing = published(daemon);
  TestClient client(daemon.control_socket());
  control::Request request;
  request.mutable_layer_diff()->set_from(0);
  const auto diff = client.ask(request).layer_diff();
  CHECK(diff.resolution_um() == 100'000);
  const LayerId id{diff.layer().origin(), diff.layer().number(), diff.layer().incarnation()};
  Replica copy(id, kDefaultResolution);
  for (const std::string& packet : diff.packets()) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(packet.data());
    CHECK(copy.apply(id, {bytes, packet.size()}) == ApplyResult::kApplied);
  }
  CHECK(hex_of(copy.digest().root()) == publishing.digest());

  const std::filesystem::path file = daemon.file("own.layer");
  request.mutable_map_save()->set_path(file.string());
  const auto saved = client.ask(request);
  REQUIRE_MESSAGE(saved.has_map_saved(), saved.error().text());
  CHECK(saved.map_saved().bytes() == std::filesystem::file_size(file));
  CHECK(saved.map_saved().voxels() > 0);
  const auto layer = read_layer(file);
  REQUIRE(layer.has_value());
  CHECK(layer->id() == id);
  CHECK(hex_of(layer->digest().root()) == publishing.digest());
}

TEST_CASE("what is held back is published on demand") {
  Config config = quick_ticks();
  config.layer.flush_after_s = 3600.0;
  RunningDaemon daemon(config);
  TestClient client(daemon.control_socket());
  control::Request request;
  request.mutable_layer_flush();
  CHECK(client.ask(request).error().text().find("no map yet") != std::string::npos);
  take_one_scan(daemon);
  const control::Publishing before = first_published(daemon);
  REQUIRE(before.blocks_held_back() > 0);
  const control::LayerFlushed flushed = client.ask(request).layer_flushed();
  CHECK(flushed.blocks() == before.blocks_held_back());
  CHECK(flushed.revision() == before.revision() + 1);
  CHECK(flushed.layer().incarnation() == before.layer().incarnation());
  CHECK(daemon.status().publishing().blocks_held_back() == 0);
  CHECK(client.ask(request).layer_flushed().blocks() == 0);
}

TEST_CASE("a map of an earlier mission is loaded, whatever its format, and counted") {
  const std::filesystem::path kept = [] {
    RunningDaemon daemon(quick_ticks());
    take_one_scan(daemon);
    published(daemon);
    for (const char* const name : {"old.layer", "old.bt"}) {
      control::Request request;
      request.mutable_map_save()->set_path(daemon.file(name).string());
      REQUIRE(TestClient(daemon.control_socket()).ask(request).has_map_saved());
    }
    auto directory = std::filesystem::temp_directory_path() / "warren-earlier-mission";
    std::filesystem::remove_all(directory);
    std::filesystem::create_directory(directory);
    for (const char* const name : {"old.layer", "old.bt"}) {
      std::filesystem::copy(daemon.file(name), directory / name);
    }
    return directory;
  }();
  RunningDaemon daemon;
  TestClient client(daemon.control_socket());
  for (const char* const name : {"old.layer", "old.bt"}) {
    const auto loaded = client.ask(load_request((kept / name).string()));
    REQUIRE_MESSAGE(loaded.has_map_loaded(), loaded.error().text());
    CHECK(loaded.map_loaded().voxels_occupied() > 0);
    CHECK(loaded.map_loaded().resolution_m() == doctest::Approx(0.1));
  }
  CHECK(daemon.status().layers_loaded() == 2);
  const auto again = client.ask(load_request((kept / "old.layer").string()));
  CHECK(again.error().text().find("already") != std::string::npos);

  const control::LoadedLayer first = daemon.status().loaded(0);
  CHECK(first.file().rfind(kept.string(), 0) == 0);
  CHECK(first.t_fleet_layer_size() == 7);
  control::Request request;
  *request.mutable_map_retract()->mutable_layer() = first.layer();
  CHECK(client.ask(request).loaded_layer().retracted());
  CHECK(daemon.status().loaded(0).retracted());
  *request.mutable_map_restore()->mutable_layer() = first.layer();
  CHECK_FALSE(client.ask(request).loaded_layer().retracted());
  *request.mutable_map_move()->mutable_layer() = first.layer();
  request.mutable_map_move()->set_y_m(2.0);
  CHECK(client.ask(request).loaded_layer().t_fleet_layer(1) ==
        doctest::Approx(first.t_fleet_layer(1) + 2.0));
  CHECK(daemon.status().layer_memory().loaded_layers_bytes() > 0);
  std::filesystem::remove_all(kept);
}

TEST_CASE("the merge-map is saved in every format but as a layer, by robot if so asked") {
  RunningDaemon daemon(quick_ticks());
  TestClient client(daemon.control_socket());
  control::Request request;
  auto& order = *request.mutable_map_save();
  order.set_path(daemon.file("merged.ply").string());
  order.set_source(control::MERGE);
  CHECK(client.ask(request).error().text().find("no map yet") != std::string::npos);
  take_one_scan(daemon);
  published(daemon);
  order.set_colours(control::ROBOT);
  for (const char* const ending : {"bt", "ot", "ply", "pcd", "png"}) {
    const std::filesystem::path file = daemon.file(std::string("merged.") + ending);
    order.set_path(file.string());
    const auto response = client.ask(request);
    REQUIRE_MESSAGE(response.has_map_saved(), response.error().text());
    CHECK(response.map_saved().bytes() == std::filesystem::file_size(file));
    CHECK(response.map_saved().voxels() > 0);
  }
  order.set_path(daemon.file("merged.layer").string());
  CHECK_FALSE(client.ask(request).error().text().empty());
  order.set_source(control::SELF);
  CHECK(client.ask(request).error().text().find("ROBOT") != std::string::npos);
}

TEST_CASE("cells are told by depth or by edge, and questions that make no sense refused") {
  RunningDaemon daemon(quick_ticks());
  take_one_scan(daemon);
  published(daemon);
  TestClient client(daemon.control_socket());
  control::Request request;
  auto& question = *request.mutable_cells();
  for (const double coordinate : {5.05, 0.0, 0.0}) question.add_low_map_m(coordinate);
  control::Cells voxel = client.ask(request).cells();
  REQUIRE(voxel.cells_size() == 1);
  CHECK(voxel.cell_m() == doctest::Approx(0.1));
  CHECK(voxel.cells(0).state() == "occupied");
  CHECK(voxel.cells(0).low_map_m(0) == doctest::Approx(5.0));
  question.set_depth(12);
  question.set_source(control::MERGE);
  const control::Cells coarse = client.ask(request).cells();
  REQUIRE(coarse.cells_size() == 1);
  CHECK(coarse.cell_m() == doctest::Approx(1.6));
  CHECK(coarse.cells(0).state() == "occupied");
  CHECK(coarse.cells(0).mixed());
  question.set_cell_m(0.5);
  CHECK(client.ask(request).cells().cell_m() == doctest::Approx(0.8));

  const auto error = [&] { return client.ask(request).error().text(); };
  question.set_depth(17);
  CHECK(error().find("0 to 16") != std::string::npos);
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    question.set_cell_m(wrong);
    CHECK(error().find("above 0") != std::string::npos);
  }
  question.clear_size();
  for (const double coordinate : {5.0, 1.0, 1.0}) question.add_high_map_m(coordinate);
  CHECK(error().find("below high_map_m") != std::string::npos);
  question.set_high_map_m(0, std::numeric_limits<double>::infinity());
  CHECK(error().find("finite") != std::string::npos);
  question.mutable_high_map_m()->RemoveLast();
  CHECK(error().find("3 numbers") != std::string::npos);
}

TEST_CASE("a load that cannot be says why") {
  RunningDaemon daemon;
  TestClient client(daemon.control_socket());
  const auto error_of = [&](const std::string& path) {
    return client.ask(load_request(path)).error().text();
  };
  CHECK(error_of("old.layer").find("absolute") != std::string::npos);
  CHECK(error_of("/nowhere/old.layer").find("/nowhere") != std::string::npos);
  CHECK(error_of("/nowhere/old.ply").find(".layer") != std::string::npos);
  control::Request none;
  none.mutable_map_retract();
  CHECK(client.ask(none).error().text().find("map_retract.layer") != std::string::npos);
  none.mutable_map_move()->mutable_layer()->set_number(1);
  CHECK(client.ask(none).error().text().find("no such layer") != std::string::npos);
  for (const double wrong : {std::nan(""), 2e8}) {
    none.mutable_map_move()->set_x_m(wrong);
    CHECK(client.ask(none).error().text().find("1e8 m") != std::string::npos);
  }
  control::Request past;
  past.mutable_layer_diff()->set_first_key(std::uint64_t{1} << 39);
  CHECK(client.ask(past).error().text().find("first_key") != std::string::npos);
}

}  // namespace warren
