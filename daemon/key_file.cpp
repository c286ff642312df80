// SPDX-License-Identifier: Apache-2.0
#include "daemon/key_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string_view>
#include <tuple>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

namespace warren {
namespace {

constexpr std::string_view kBegin = "warren-fleet-key-1 ";
constexpr std::size_t kHexDigits = 2 * std::tuple_size_v<mesh::Key>;
constexpr std::size_t kTextBytes = kBegin.size() + kHexDigits + 1;  // and the line's end
constexpr mode_t kOthers = S_IRWXG | S_IRWXO;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

tl::unexpected<std::string> failure(const std::filesystem::path& file, const std::string& why) {
  return tl::unexpected("key file " + file.string() + ": " + why);
}

tl::unexpected<std::string> system_failure(const std::filesystem::path& file, const char* what) {
  const std::string hint = errno == ENOENT ? "; make one with: warrenctl key new FILE" : "";
  return failure(file, std::string(what) + ": " + std::strerror(errno) + hint);
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::optional<mesh::Key> key_of(std::string_view text) {
  if (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  if (text.size() != kBegin.size() + kHexDigits || text.substr(0, kBegin.size()) != kBegin) {
    return std::nullopt;
  }
  mesh::Key key;
  std::size_t bytes = 0;
  const int failed = sodium_hex2bin(key.data(), key.size(), text.data() + kBegin.size(), kHexDigits,
                                    nullptr, &bytes, nullptr);
  return failed == 0 && bytes == key.size() ? std::optional(key) : std::nullopt;
}

}  // namespace

tl::expected<mesh::Key, std::string> read_key_file(const std::filesystem::path& file) {
  const Descriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.number() < 0) return system_failure(file, "cannot open");
  struct stat facts {};
  if (fstat(opened.number(), &facts) != 0) return system_failure(file, "cannot look at it");
  if (!S_ISREG(facts.st_mode)) return failure(file, "is no regular file");
  if ((facts.st_mode & kOthers) != 0) {
    return failure(file,
                   "others than its owner may read or write it; chmod 600 it, and if it has "
                   "been read, make a new one for the whole fleet");
  }
  std::array<char, kTextBytes + 1> text{};
  const ssize_t got = read(opened.number(), text.data(), text.size());
  if (got < 0) return system_failure(file, "cannot read");
  const auto key = key_of({text.data(), static_cast<std::size_t>(got)});
  sodium_memzero(text.data(), text.size());
  if (!key) return failure(file, "holds no fleet key; make one with: warrenctl key new FILE");
  return *key;
}

tl::expected<void, std::string> make_key_file(const std::filesystem::path& file) {
  if (sodium_init() < 0) return failure(file, "libsodium finds no randomness");
  mesh::Key key;
  randombytes_buf(key.data(), key.size());
  std::array<char, kHexDigits + 1> hex{};
  sodium_bin2hex(hex.data(), hex.size(), key.data(), key.size());
  const std::string text = std::string(kBegin) + hex.data() + "\n";
  const Descriptor made(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (made.number() < 0) {
    if (errno == EEXIST) return failure(file, "is there already, and may be in use; it stays");
    return tl::unexpected("key file " + file.string() +
                          ": cannot make it: " + std::strerror(errno));
  }
  if (!write_all(made.number(), text) || fsync(made.number()) != 0) {
    const auto failed = system_failure(file, "cannot write");
    unlink(file.c_str());
    return failed;
  }
  return {};
}

}  // namespace warren
