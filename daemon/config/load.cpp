// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/load.hpp"

#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "daemon/config/document.hpp"
#include "daemon/config/faults.hpp"

namespace warren {
namespace {

tl::unexpected<ConfigFaults> one_fault(std::string text) {
  return tl::unexpected(ConfigFaults{std::move(text)});
}

// Where documents begin; their content is passed over.
class DocumentStarts : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> marks;

  void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// Looks for a second document. Not by YAML::LoadAll: yaml-cpp 0.7 does not get past a stray comma
// and finds empty documents there for ever, each taking memory (its issue 1040).
std::optional<std::string> find_second_document(const std::string& yaml, const std::string& name) {
  std::istringstream stream(yaml);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  while (starts.marks.size() < 2 && parser.HandleNextDocument(starts)) {
  }
  if (starts.marks.size() < 2) return std::nullopt;
  const YAML::Mark& second = starts.marks.back();
  const bool stands_still = second.pos == starts.marks.front().pos;
  return name + ":" + std::to_string(second.line + 1) + ": " +
         (stands_still ? "this is no YAML" : "more than one YAML document");
}

}  // namespace

tl::expected<Config, ConfigFaults> parse_config(const std::string& yaml, const std::string& name) {
  if (yaml.size() > kMaxConfigBytes) return one_fault(name + ": larger than 1 MiB");
  try {
    if (auto second = find_second_document(yaml, name)) return one_fault(*std::move(second));
    FaultList faults(name);
    Config config = read_document(YAML::Load(yaml), faults);
    if (faults.empty()) return config;
    return tl::unexpected(faults.in_line_order());
  } catch (const YAML::Exception& error) {
    return one_fault(name + ":" + std::to_string(error.mark.line + 1) + ": " + one_line(error.msg));
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
