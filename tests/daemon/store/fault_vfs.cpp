// SPDX-License-Identifier: Apache-2.0
#include "tests/daemon/store/fault_vfs.hpp"

#include <algorithm>
#include <cstring>

namespace warren::test {

// Reads fail too while the power is off.
struct FaultVfs::Calls {
  static FaultVfs& self(sqlite3_vfs* vfs) { return *static_cast<FaultVfs*>(vfs->pAppData); }
  static Handle& handle(sqlite3_file* file) { return *reinterpret_cast<Handle*>(file); }

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* out) {
    FaultVfs& disk = self(vfs);
    Handle& opened = handle(file);
    opened.base.pMethods = nullptr;
    if (disk.is_off()) return SQLITE_CANTOPEN;
    opened.vfs = &disk;
    opened.temporary = name == nullptr;
    if (name == nullptr) {
      disk.temporary_.push_back(std::make_unique<File>());
      opened.file = disk.temporary_.back().get();
    } else {
      const auto found = disk.files_.find(name);
      if (found == disk.files_.end() && (flags & SQLITE_OPEN_CREATE) == 0) return SQLITE_CANTOPEN;
      auto& kept = disk.files_[name];
      if (!kept) kept = std::make_unique<File>();
      opened.file = kept.get();
    }
    if (out != nullptr) *out = flags;
    opened.base.pMethods = &methods();
    return SQLITE_OK;
  }
  static int remove(sqlite3_vfs* vfs, const char* name, int) {
    FaultVfs& disk = self(vfs);
    if (const int refused = disk.change()) return refused;
    return disk.files_.erase(name) != 0 ? SQLITE_OK : SQLITE_IOERR_DELETE_NOENT;
  }
  static int access(sqlite3_vfs* vfs, const char* name, int, int* out) {
    *out = self(vfs).files_.contains(name) ? 1 : 0;
    return SQLITE_OK;
  }
  static int full_name(sqlite3_vfs*, const char* name, int size, char* out) {
    sqlite3_snprintf(size, out, "%s", name);
    return SQLITE_OK;
  }
  static int randomness(sqlite3_vfs* vfs, int bytes, char* out) {
    for (int i = 0; i < bytes; ++i) out[i] = static_cast<char>(self(vfs).random_());
    return bytes;
  }
  static int sleep(sqlite3_vfs*, int microseconds) { return microseconds; }
  static int current_time(sqlite3_vfs*, double* out) {
    *out = 2460000.5;
    return SQLITE_OK;
  }

  static int close(sqlite3_file*) { return SQLITE_OK; }
  static int read(sqlite3_file* file, void* to, int bytes, sqlite3_int64 offset) {
    if (handle(file).vfs->is_off()) return SQLITE_IOERR_READ;
    const Bytes& seen = handle(file).file->seen;
    const auto wanted = static_cast<std::size_t>(bytes);
    const std::size_t from = std::min(static_cast<std::size_t>(offset), seen.size());
    const std::size_t there = std::min(wanted, seen.size() - from);
    std::memset(to, 0, wanted);
    if (there > 0) std::memcpy(to, seen.data() + from, there);
    return there == wanted ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
  }
  static int write(sqlite3_file* file, const void* from, int bytes, sqlite3_int64 offset) {
    return handle(file).vfs->write(*handle(file).file, from, static_cast<std::size_t>(bytes),
                                   static_cast<std::size_t>(offset));
  }
  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    return handle(file).vfs->truncate(*handle(file).file, static_cast<std::size_t>(size));
  }
  static int sync(sqlite3_file* file, int) { return handle(file).vfs->sync(*handle(file).file); }
  static int size(sqlite3_file* file, sqlite3_int64* out) {
    *out = static_cast<sqlite3_int64>(handle(file).file->seen.size());
    return SQLITE_OK;
  }
  static int lock(sqlite3_file*, int) { return SQLITE_OK; }
  static int check_lock(sqlite3_file*, int* out) {
    *out = 0;
    return SQLITE_OK;
  }
  static int control(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
  static int sector(sqlite3_file*) { return static_cast<int>(kSectorBytes); }
  // As the usual file system of SQLite says.
  static int characteristics(sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }

  static const sqlite3_io_methods& methods() {
    static const sqlite3_io_methods kMethods = [] {
      sqlite3_io_methods all{};
      all.iVersion = 1;  // without shared memory
      all.xClose = close;
      all.xRead = read;
      all.xWrite = write;
      all.xTruncate = truncate;
      all.xSync = sync;
      all.xFileSize = size;
      all.xLock = lock;
      all.xUnlock = lock;
      all.xCheckReservedLock = check_lock;
      all.xFileControl = control;
      all.xSectorSize = sector;
      all.xDeviceCharacteristics = characteristics;
      return all;
    }();
    return kMethods;
  }
};

FaultVfs::FaultVfs(std::uint32_t seed) : random_(seed) {
  static std::uint32_t made = 0;
  name_ = "warren-fault-" + std::to_string(++made);
  vfs_.iVersion = 1;
  vfs_.szOsFile = sizeof(Handle);
  vfs_.mxPathname = 512;
  vfs_.zName = name_.c_str();
  vfs_.pAppData = this;
  vfs_.xOpen = Calls::open;
  vfs_.xDelete = Calls::remove;
  vfs_.xAccess = Calls::access;
  vfs_.xFullPathname = Calls::full_name;
  vfs_.xRandomness = Calls::randomness;
  vfs_.xSleep = Calls::sleep;
  vfs_.xCurrentTime = Calls::current_time;
  sqlite3_vfs_register(&vfs_, 0);
}

FaultVfs::~FaultVfs() { sqlite3_vfs_unregister(&vfs_); }

int FaultVfs::change() {
  if (is_off()) return SQLITE_IOERR;
  ++changes_;
  if (fail_one_in_ != 0 && random_() % fail_one_in_ == 0) return SQLITE_IOERR;
  return SQLITE_OK;
}

void FaultVfs::apply(const Change& change, Bytes& to) {
  if (change.bytes.empty()) {
    to.resize(std::min(to.size(), change.offset));
    return;
  }
  to.resize(std::max(to.size(), change.offset + change.bytes.size()));
  std::copy(change.bytes.begin(), change.bytes.end(),
            to.begin() + static_cast<std::ptrdiff_t>(change.offset));
}

// The write during which the power goes is among those that may survive.
int FaultVfs::write(File& file, const void* from, std::size_t bytes, std::size_t offset) {
  const bool was_off = is_off();
  const int refused = change();
  if (was_off) return SQLITE_IOERR_WRITE;
  const std::size_t growth = std::max(file.seen.size(), offset + bytes) - file.seen.size();
  if (growth > 0 && this->bytes() + growth > capacity_) return SQLITE_FULL;
  const auto* const data = static_cast<const std::uint8_t*>(from);
  file.unsynced.push_back({offset, Bytes(data, data + bytes)});
  apply(file.unsynced.back(), file.seen);
  return refused != SQLITE_OK ? SQLITE_IOERR_WRITE : SQLITE_OK;
}

int FaultVfs::truncate(File& file, std::size_t size) {
  if (change() != SQLITE_OK) return SQLITE_IOERR_TRUNCATE;
  file.unsynced.push_back({size, {}});
  apply(file.unsynced.back(), file.seen);
  return SQLITE_OK;
}

int FaultVfs::sync(File& file) {
  ++syncs_;
  const bool was_off = is_off();
  const int refused = change();
  if (was_off) return SQLITE_IOERR_FSYNC;
  if (refused != SQLITE_OK) {
    // As Linux does it: what could not be written is forgotten, yet still seen.
    keep_some(file, 50);
    return SQLITE_IOERR_FSYNC;
  }
  if (lies_) return SQLITE_OK;
  for (const Change& unsynced : file.unsynced) apply(unsynced, file.durable);
  file.unsynced.clear();
  file.was_synced = true;
  return SQLITE_OK;
}

void FaultVfs::keep_some(File& file, std::uint32_t percent) {
  const auto survives = [&] { return random_() % 100 < percent; };
  for (const Change& unsynced : file.unsynced) {
    if (unsynced.bytes.empty() && survives()) apply(unsynced, file.durable);
    for (std::size_t from = 0; from < unsynced.bytes.size();) {
      const std::size_t place = unsynced.offset + from;
      const std::size_t end =
          std::min(unsynced.bytes.size(), from + kSectorBytes - place % kSectorBytes);
      const auto first = unsynced.bytes.begin() + static_cast<std::ptrdiff_t>(from);
      const auto past = unsynced.bytes.begin() + static_cast<std::ptrdiff_t>(end);
      if (survives()) apply({place, Bytes(first, past)}, file.durable);
      from = end;
    }
  }
  file.unsynced.clear();
}

void FaultVfs::power_on() {
  const std::uint32_t percent = std::vector<std::uint32_t>{0, 20, 50, 90, 100}[random_() % 5];
  for (auto entry = files_.begin(); entry != files_.end();) {
    File& file = *entry->second;
    keep_some(file, percent);
    file.seen = file.durable;
    // A name that was never synced need not be there.
    const bool gone = !file.was_synced && random_() % 2 == 0;
    entry = gone ? files_.erase(entry) : std::next(entry);
  }
  temporary_.clear();
  off_at_ = ~std::uint64_t{0};
}

std::uint64_t FaultVfs::bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& [name, file] : files_) bytes += file->seen.size();
  return bytes;
}

}  // namespace warren::test
