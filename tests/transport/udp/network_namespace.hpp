// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace warren::mesh::test {

// A network of its own, without a name: it goes with the object, whatever happens.
class NetworkNamespace {
 public:
  // Nothing, and SKIPPED: is said, if this process may not make one.
  static std::optional<NetworkNamespace> make();

  ~NetworkNamespace();
  NetworkNamespace(NetworkNamespace&& other) noexcept;
  NetworkNamespace& operator=(NetworkNamespace&&) = delete;

  // The calling thread lives there from now on.
  void enter() const;
  // A command of iproute2, without "ip". True if it succeeded.
  bool ip(const std::string& arguments) const;
  // For `ip link ... netns`.
  std::string path() const;

 private:
  explicit NetworkNamespace(int descriptor) : descriptor_(descriptor) {}

  int descriptor_ = -1;
};

// Two namespaces joined by a cable: "radio0" in both, up, with 10.9.0.1 and .2 of 24 bits, and
// link-local IPv6 addresses that can be used at once.
struct CabledNamespaces {
  NetworkNamespace first, second;
  static std::optional<CabledNamespaces> make();
};

}  // namespace warren::mesh::test
