// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/link/link_model.hpp"
#include "tools/warren-link/file_descriptor.hpp"
#include "tools/warren-link/mac_table.hpp"

namespace warren {

MeshTime monotonic_now();

// How late packets left the emulator, against the model.
struct Lateness {
  std::uint64_t packets = 0;
  Duration sum{};
  Duration max{};
};

struct DeviceErrors {
  std::uint64_t read = 0;
  std::uint64_t write = 0;  // the interface was down, mostly
};

// Carries packets between the devices as the model says.
class Emulator {
 public:
  Emulator(LinkModel model, std::vector<FileDescriptor> devices, bool ethernet);

  int device(std::size_t node) const { return devices_[node].get(); }
  // Takes what the node has sent, some packets at most.
  void take_from(std::size_t node);
  // Hands over what is due. Returns when there will be more; kNever if nothing is under way.
  MeshTime deliver();
  void set_silent(bool silent) { model_.set_silent(monotonic_now(), silent); }

  const LinkModel& model() const { return model_; }
  const Lateness& lateness() const { return lateness_; }
  const DeviceErrors& errors(std::size_t node) const { return errors_[node]; }

 private:
  LinkModel model_;
  std::vector<FileDescriptor> devices_;
  std::vector<DeviceErrors> errors_;
  bool ethernet_;
  MacTable mac_table_;
  Lateness lateness_;
};

}  // namespace warren
