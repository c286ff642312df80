// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/load.hpp"

#include <cstring>
#include <fstream>

#include <yaml-cpp/yaml.h>

#include "daemon/config/document.hpp"
#include "daemon/config/faults.hpp"

namespace warren {
namespace {

tl::unexpected<ConfigFaults> one_fault(std::string text) {
  return tl::unexpected(ConfigFaults{std::move(text)});
}

}  // namespace

tl::expected<Config, ConfigFaults> parse_config(const std::string& yaml, const std::string& name) {
  if (yaml.size() > kMaxConfigBytes) return one_fault(name + ": larger than 1 MiB");
  try {
    const auto documents = YAML::LoadAll(yaml);
    if (documents.size() > 1) return one_fault(name + ": more than one YAML document");
    FaultList faults(name);
    const YAML::Node root = documents.empty() ? YAML::Node() : documents.front();
    Config config = read_document(root, faults);
    if (faults.empty()) return config;
    return tl::unexpected(faults.in_line_order());
  } catch (const YAML::Exception& error) {
    return one_fault(name + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

tl::expected<Config, ConfigFaults> load_config(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return one_fault(file.string() + ": cannot open: " + std::strerror(errno));
  std::string text(kMaxConfigBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) return one_fault(file.string() + ": cannot read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return parse_config(text, file.string());
}

std::string join_lines(const ConfigFaults& faults) {
  std::string text;
  for (const std::string& fault : faults) text += (text.empty() ? "" : "\n") + fault;
  return text;
}

}  // namespace warren
