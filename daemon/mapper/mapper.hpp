// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/ingest/replies.hpp"
#include "daemon/mapper/layered_map.hpp"
#include "daemon/mapper/scan_queue.hpp"

namespace warren {

using SensorFilters = std::map<std::string, SensorFilter>;

struct MapperStatus {
  MapInfoReport map;
  RejectionCounts rejected_points{};
  std::uint64_t scans = 0;
  double integrate_cpu_ms_mean = 0.0;
  double integrate_cpu_ms_max = 0.0;
};

// The mapping thread: it alone touches the map. Others push scans and ask questions; answers and
// receipts are called back on the mapping thread, so callbacks must be short and must not wait.
// Every member function may be called from any thread.
class Mapper {
 public:
  // Clients' questions and orders that may wait; one more is refused. A client waits for its answer
  // before it asks again, but one that goes and comes back leaves its question behind.
  static constexpr std::size_t kMaxCommands = 1024;

  struct Dependencies {
    // What became of each scan that was not dropped by push().
    std::function<void(const QueuedScan&, const ScanReceipt&)> deliver_receipt;
    std::function<void()> before_scan = [] {};  // tests hold the thread here
  };

  Mapper(const MappingConfig& config, SensorFilters filters, std::size_t queue_scans,
         Dependencies dependencies, StoredMap stored = {});
  // Integrates what is queued first.
  ~Mapper();
  Mapper(const Mapper&) = delete;
  Mapper& operator=(const Mapper&) = delete;

  // Those that were dropped to make room.
  std::vector<QueuedScan> push(QueuedScan scan);
  // Answered after all scans pushed before it: a client sees its messages take effect in order.
  // False: refused, too many commands wait; there will be no answer.
  [[nodiscard]] bool update_pose(const PoseUpdateMessage& update,
                                 std::function<void(bool applied)> answer);

  // Clients' questions: while scans wait, one goes before each, so that asking without end delays
  // a scan by one answer. False as above.
  [[nodiscard]] bool ask_status(std::function<void(MapperStatus)> answer);
  [[nodiscard]] bool ask_snapshot(std::function<void(std::shared_ptr<const MapSnapshot>)> answer);
  using GroundResult = tl::expected<GroundAnswer, std::string>;
  [[nodiscard]] bool ask_ground(const GroundQuestion& question,
                                std::function<void(const GroundResult&)> answer);
  // The daemon's own, before all that waits. A tick: what changed since the last one is handed
  // over.
  void ask_changes(std::function<void(std::vector<LayerChanges>)> answer);
  void set_filters(SensorFilters filters);
  void set_queue_capacity(std::size_t scans);

  struct QueueLoad {
    std::size_t scans = 0;
    std::size_t capacity = 0;
  };
  QueueLoad queue_load() const;

  // Liveness: ask for a beat, see later whether the count has moved.
  void request_beat();
  std::uint64_t beats() const { return beats_.load(); }

  // Integrates and answers everything in hand, hands over the last changes, ends the thread.
  using Finished = std::function<void(std::vector<LayerChanges>)>;
  void finish(Finished finished);

 private:
  struct PoseOrder {
    std::uint64_t after_scans = 0;  // runs once so many scans have left the queue
    std::function<void()> run;
  };

  void run();
  // Waits for work; false when there is none and none will come.
  bool wait_for_work(std::unique_lock<std::mutex>& lock);
  // The next that is due, taken off its queue; nothing when none is.
  std::function<void()> take_command();
  bool question_is_due() const;
  bool pose_order_is_due() const;
  bool command_is_due() const;
  [[nodiscard]] bool ask(std::function<void()> question);
  void post(std::function<void()> run);
  void integrate(QueuedScan& scan);
  ScanReceipt receipt_of(ScanMessage& message);
  void count_cpu(double cpu_ms);
  MapperStatus status() const;

  Dependencies dependencies_;

  mutable std::mutex mutex_;  // guards what follows, up to finishing_
  std::condition_variable work_;
  ScanQueue queue_;
  std::deque<std::function<void()>> own_;  // of the daemon itself: few, never refused, always due
  std::deque<std::function<void()>> questions_;
  bool question_passed_ = false;  // since the last scan
  std::deque<PoseOrder> pose_orders_;
  Finished finished_;
  bool finishing_ = false;

  std::atomic<bool> beat_requested_{false};
  std::atomic<std::uint64_t> beats_{0};

  // Of the mapping thread.
  LayeredMap map_;
  SensorFilters filters_;
  std::uint64_t scans_ = 0;
  double cpu_ms_sum_ = 0.0;
  double cpu_ms_max_ = 0.0;

  std::thread thread_;
};

}  // namespace warren
