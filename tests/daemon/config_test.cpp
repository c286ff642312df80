// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>

#include "daemon/config/load.hpp"
#include "daemon/config/print.hpp"
#include "daemon/config/value.hpp"
#include "transport/udp/address_text.hpp"

namespace warren {
namespace {

ConfigFaults faults_of(const std::string& yaml) {
  const auto config = parse_config(yaml, "robot.yaml");
  return config ? ConfigFaults{} : config.error();
}

void check_fault(const std::string& yaml, const std::string& fault) {
  CAPTURE(yaml);
  const ConfigFaults faults = faults_of(yaml);
  REQUIRE(faults.size() == 1);
  CHECK(faults.front() == fault);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

Config unusual_config() {
  Config config;
  config.node.name = "null";
  config.sockets.ingest = {"/tmp/with 'quotes' and spaces", FileMode{0007}};
  config.map.resolution_m = 0.123456789012345;
  config.map.sensor_model = {SensorModelPreset::kCustom, 0.8, 0.3, 0.01, 0.99};
  config.map.one_ray_per_end_voxel = true;
  config.ingest = {1024, 4194304, 256, 0.05};
  config.log = {LogLevel::kOff, LogFormat::kJournal};
  SensorConfig rear;
  rear.name = "rear-2";
  rear.max_range_m.reset();
  rear.body_box_low_m = Eigen::Vector3d(-1.5, -0.25, -100.0);
  rear.body_box_high_m = Eigen::Vector3d(0.0, 1e-5, 100.0);
  config.sensors.push_back(rear);
  config.node.fleet_T_map = {-12.5, 1e-3, 1e6, -90.0};
  config.mesh = {"/etc/a key", 0, 1, true, 0.0, {}};
  MeshInterfaceConfig radio{"wlx0", false, true, false, true, 576, 50.5, {}};
  radio.seeds = {*mesh::parse_mesh_address("10.9.0.2:7717"),
                 *mesh::parse_mesh_address("[fe80::1]:7718")};
  config.mesh.interfaces = {radio, MeshInterfaceConfig{}};
  config.share = {SharePolicyChoice::kNear, 12.0};
  return config;
}

}  // namespace

TEST_CASE("an empty file is the defaults") {
  REQUIRE(parse_config("", "x").has_value());
  CHECK(*parse_config("", "x") == Config{});
  CHECK(*parse_config("# only a comment\n", "x") == Config{});
  CHECK(*parse_config("node:\nmap:\n  sensor_model:\n", "x") == Config{});
}

TEST_CASE("the shipped configs are the commented prints of the defaults") {
  const std::filesystem::path folder = std::filesystem::path(WARREN_SOURCE_DIR) / "config";
  for (const auto& [role, defaults] :
       {std::pair{"robot", Config{}}, std::pair{"base", Config::of_base()}}) {
    const auto file = folder / (std::string(role) + ".yaml");
    CAPTURE(file);
    const auto loaded = load_config(file);
    REQUIRE_MESSAGE(loaded.has_value(), join_lines(loaded.error()));
    CHECK(*loaded == defaults);
    CHECK_MESSAGE(text_of(file) == print_sample(defaults),
                  "regenerate it: warrend --print-sample ROLE >config/ROLE.yaml");
  }
}

TEST_CASE("what is printed loads back equal") {
  for (const Config& config : {Config{}, Config::of_base(), unusual_config()}) {
    for (const std::string& text : {print_config(config), print_sample(config)}) {
      const auto loaded = parse_config(text, "printed");
      REQUIRE_MESSAGE(loaded.has_value(), join_lines(loaded.error()));
      CHECK(*loaded == config);
    }
  }
}

TEST_CASE("every default lies within its own limits") {
  Config config;
  for (const RootKey& key : root_keys()) {
    CAPTURE(key.name);
    const ValueRule rule{key.limits, key.choices};
    const std::string printed = print_value(key.slot(config), rule);
    const bool is_text = printed.front() == '\'';
    const std::string text = is_text ? printed.substr(1, printed.size() - 2) : printed;
    const RawValue raw{false, {{text, is_text, printed == "null"}}};
    CHECK(read_value(raw, key.slot(config), rule).has_value());
  }
  CHECK(config == Config{});
}

TEST_CASE("a fault names file, line, key, value and what is allowed") {
  check_fault("map:\n  resolution_m: 7\n",
              "robot.yaml:2: map.resolution_m: '7' is out of range; allowed: 0.01 to 1");
  check_fault("\nlog:\n  level: loud\n",
              "robot.yaml:3: log.level: 'loud' is none of these; allowed: debug, info, warning, "
              "error, off");
  check_fault("ingest: {queue_scans: 1.5}\n",
              "robot.yaml:1: ingest.queue_scans: '1.5' is not a whole number; allowed: 1 to 1024, "
              "whole numbers");
  check_fault("map: {resolution_m: \"0.1\"}\n",
              "robot.yaml:1: map.resolution_m: '0.1' is not a number; allowed: 0.01 to 1");
  check_fault("map: {resolution_m: .nan}\n",
              "robot.yaml:1: map.resolution_m: '.nan' is not a number; allowed: 0.01 to 1");
  check_fault("map: {one_ray_per_end_voxel: yes}\n",
              "robot.yaml:1: map.one_ray_per_end_voxel: 'yes' is not true or false; allowed: "
              "true, false");
  check_fault("map: {resolution_m: [0.1]}\n",
              "robot.yaml:1: map.resolution_m: '[0.1]' is a list; allowed: 0.01 to 1");
  check_fault("nodes: {name: x}\n", "robot.yaml:1: nodes: unknown key");
  check_fault("node:\n  name: a\n  name: b\n", "robot.yaml:3: node.name: stands here twice");
  check_fault("node: 5\n", "robot.yaml:1: node: must be a section of keys");
  check_fault("sockets: {ingest: {path: here.sock}}\n",
              "robot.yaml:1: sockets.ingest.path: 'here.sock' is not an absolute path; allowed: an "
              "absolute path of at most 107 bytes");
  check_fault("sockets: {ingest: {mode: 660}}\n",
              "robot.yaml:1: sockets.ingest.mode: '660' is not a file mode; allowed: 0000 to 0777, "
              "four octal digits");
}

TEST_CASE("sensors are checked one by one") {
  check_fault("sensors: []\n", "robot.yaml:1: sensors: a robot needs at least one");
  check_fault("sensors: 5\n", "robot.yaml:1: sensors: must be a list of at most 16 sensors");
  check_fault("sensors:\n  - name: a\n  - name: a\n",
              "robot.yaml:3: sensors[1].name: 'a' is taken by a sensor above");
  check_fault("sensors:\n  - min_range_m: 1\n",
              "robot.yaml:2: sensors[0].name: missing: every sensor needs one");
  check_fault("sensors:\n  - name: a\n    range: 5\n",
              "robot.yaml:3: sensors[0].range: unknown key");
  check_fault("sensors:\n  - name: a\n    min_range_m: 5\n    max_range_m: 4\n",
              "robot.yaml:4: sensors[0].max_range_m: must be above min_range_m");
  check_fault("sensors:\n  - name: a\n    max_range_m: null\n    carve_no_returns: true\n",
              "robot.yaml:4: sensors[0].carve_no_returns: needs max_range_m: how far to carve");
  check_fault("sensors:\n  - name: a\n    body_box:\n      low_m: [0, 0, 0]\n",
              "robot.yaml:4: sensors[0].body_box.low_m: a body box needs both low_m and high_m");
}

TEST_CASE("a base has no sensors, and needs to name none") {
  const auto base = parse_config("node: {role: base}\n", "base.yaml");
  REQUIRE_MESSAGE(base.has_value(), join_lines(base.error()));
  CHECK(base->sensors.empty());
  CHECK(parse_config("sensors: []\nnode: {role: base}\n", "base.yaml").has_value());
  check_fault("node: {role: base}\nsensors:\n  - name: a\n",
              "robot.yaml:2: sensors: a base has none: leave them out, or let node.role be robot");
}

TEST_CASE("a base holds everything, a robot what its policy says") {
  for (const std::string policy : {"near", "nothing"}) {
    const std::string share = "share: {policy: " + policy + "}\n";
    CHECK(faults_of(share).empty());
    check_fault("node: {role: base}\n" + share,
                "robot.yaml:2: share.policy: a base holds everything: leave it out, or let "
                "node.role be robot");
  }
  CHECK(faults_of("node: {role: base}\nshare: {policy: everything}\n").empty());
}

TEST_CASE("the mesh is off until an interface is named, and interfaces are checked one by one") {
  CHECK_FALSE(Config{}.mesh.is_on());
  const auto config = parse_config(
      "mesh:\n  interfaces:\n    - name: wlan0\n      ceiling_kbit_s: 250\n"
      "      seeds: ['10.0.0.1:7717']\n",
      "robot.yaml");
  REQUIRE_MESSAGE(config.has_value(), join_lines(config.error()));
  CHECK(config->mesh.is_on());
  CHECK(config->mesh.interfaces.front().ceiling_kbit_s == 250.0);
  CHECK(config->mesh.interfaces.front().seeds.size() == 1);

  const std::string one = "mesh:\n  interfaces:\n    - name: wlan0\n";
  check_fault("mesh: {interfaces: wlan0}\n",
              "robot.yaml:1: mesh.interfaces: must be a list of at most 8 interfaces");
  check_fault("mesh:\n  interfaces:\n    - ipv6: true\n",
              "robot.yaml:3: mesh.interfaces[0].name: missing: every interface needs one");
  check_fault(one + "    - name: wlan0\n",
              "robot.yaml:4: mesh.interfaces[1].name: 'wlan0' is taken by an interface above");
  check_fault(one + "      ipv4: false\n",
              "robot.yaml:4: mesh.interfaces[0].ipv4: must be true where ipv6 is not");
  check_fault(one + "      ipv4: false\n      ipv6: true\n      broadcast: true\n",
              "robot.yaml:6: mesh.interfaces[0].broadcast: needs ipv4");
  check_fault(one + "      mtu_bytes: 500\n",
              "robot.yaml:4: mesh.interfaces[0].mtu_bytes: '500' is out of range; allowed: 576 to "
              "9000, whole numbers");
  check_fault(one + "      seeds: [base:7717]\n",
              "robot.yaml:4: mesh.interfaces[0].seeds: '[base:7717]' has something that is no "
              "address and port; allowed: a list of at most 64 addresses with ports, e.g. "
              "['10.9.0.2:7717', '[fe80::1]:7717']");
  check_fault("mesh: {port: 7717}\n",
              "robot.yaml:1: mesh.port: is mesh.group_port too; they need two");
}

TEST_CASE("a surveyed start is a level pose in the fleet frame") {
  const auto config =
      parse_config("node: {fleet_T_map: {x_m: 3, y_m: -1, z_m: 0.5, yaw_deg: 90}}\n", "x");
  REQUIRE(config.has_value());
  const Pose pose = config->node.fleet_T_map.pose();
  const Eigen::Vector3d moved = *pose.checked() * Eigen::Vector3d(2.0, 0.0, 0.0);
  CHECK(moved.isApprox(Eigen::Vector3d(3.0, 1.0, 0.5)));
}

TEST_CASE("contradictions are faults") {
  check_fault("map: {sensor_model: {hit: 0.8}}\n",
              "robot.yaml:1: map.sensor_model.hit: only with preset: custom");
  CHECK(faults_of("map: {sensor_model: {preset: custom}}\n").size() == 4);
  check_fault("terrain: {step_harmless_m: 0.3}\n",
              "robot.yaml:1: terrain.step_critical_m: must be above step_harmless_m");
  check_fault("sockets: {ingest: {path: /a}, control: {path: /a}}\n",
              "robot.yaml:1: sockets.control.path: is sockets.ingest.path too; they need two");
}

TEST_CASE("all faults are told at once, in the order of lines") {
  const ConfigFaults faults =
      faults_of("nodes: 1\nmap:\n  resolution_m: x\nlog:\n  level: 3\n  colour: red\n");
  REQUIRE(faults.size() == 4);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    CAPTURE(faults[i]);
    const std::size_t line = std::array<std::size_t, 4>{1, 3, 5, 6}[i];
    CHECK(faults[i].rfind("robot.yaml:" + std::to_string(line) + ": ", 0) == 0);
  }
}

TEST_CASE("text that is no YAML is one fault with its line") {
  const ConfigFaults faults = faults_of("node:\n  name: [\n");
  REQUIRE(faults.size() == 1);
  CHECK(faults.front().rfind("robot.yaml:", 0) == 0);
  check_fault("a: 1\n---\nb: 2\n", "robot.yaml:2: more than one YAML document");
  CHECK(faults_of(std::string(kMaxConfigBytes + 1, ' ')).size() == 1);
}

TEST_CASE("a stray comma, at which yaml-cpp finds documents without end, is one fault") {
  check_fault(",", "robot.yaml:1: this is no YAML");
  check_fault("# comment\n%YAML 1.2\n,\n", "robot.yaml:3: this is no YAML");
  check_fault("---\n,", "robot.yaml:2: more than one YAML document");
}

TEST_CASE("control characters of keys and values do not reach the operator's terminal") {
  check_fault("node:\n  role: \"a\\nb\"\n",
              "robot.yaml:2: node.role: 'a?b' is none of these; allowed: robot, base");
  check_fault("\"\\e[2J\": 1\n", "robot.yaml:1: ?[2J: unknown key");
}

TEST_CASE("a file that is not there is a fault") {
  const auto config = load_config("/nowhere/robot.yaml");
  REQUIRE_FALSE(config.has_value());
  CHECK(config.error().front() == "/nowhere/robot.yaml: cannot open: No such file or directory");
}

TEST_CASE("a reload takes what it can and names what it cannot") {
  Config wanted;
  wanted.log.level = LogLevel::kDebug;
  wanted.sensors.front().max_range_m = 5.0;
  wanted.map.resolution_m = 0.2;
  wanted.mesh.interfaces.resize(1);
  const ConfigChanges changes = compare_configs(Config{}, wanted);
  CHECK(changes.effective == std::vector<std::string>{"log.level", "sensors"});
  CHECK(changes.needs_restart == std::vector<std::string>{"map.resolution_m", "mesh.interfaces"});

  const Config result = reloaded(Config{}, wanted);
  CHECK(result.log.level == LogLevel::kDebug);
  CHECK(result.sensors == wanted.sensors);
  CHECK(result.map == Config{}.map);
  CHECK(result.mesh == Config{}.mesh);
}

TEST_CASE("the terrain's settings reach the judge and the fusion of costs") {
  const auto config = parse_config(
      "terrain: {profile: robust, saturation: 1, step_harmless_m: 0.1, step_critical_m: 0.4, "
      "fusion: paper}\n",
      "robot.yaml");
  REQUIRE(config.has_value());
  const TerrainConfig terrain = config->terrain.resolved();
  CHECK(terrain.cost.saturation == 1.0F);
  REQUIRE(terrain.cost.step);
  CHECK(terrain.cost.step->limits.share_of(0.1F) == 0.0F);
  CHECK(terrain.cost.step->limits.share_of(0.4F) == doctest::Approx(1.0));
  CHECK(config->self_map().cost_fusion.rule == CostRule::kPaper);
  const auto paper = parse_config("terrain: {profile: paper}\n", "robot.yaml");
  CHECK_FALSE(paper.value().terrain.resolved().cost.step);
  CHECK_FALSE(paper.value().terrain.resolved().cost.roughness);
}

}  // namespace warren
