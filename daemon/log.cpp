// SPDX-License-Identifier: Apache-2.0
#include "daemon/log.hpp"

#include <cstdlib>
#include <memory>
#include <string>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "daemon/printable.hpp"

namespace warren {
namespace {

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
    case LogLevel::kOff:
      break;
  }
  return spdlog::level::off;
}

bool goes_to_journal(LogFormat format) {
  if (format != LogFormat::kAuto) return format == LogFormat::kJournal;
  return std::getenv("JOURNAL_STREAM") != nullptr;  // NOLINT(concurrency-mt-unsafe)
}

spdlog::logger& logger() {
  static spdlog::logger instance("warren", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  return instance;
}

bool journal = false;  // written before the threads start

void write(LogLevel level, char priority, std::string_view message) {
  const auto spdlog_level = level_of(level);
  if (!logger().should_log(spdlog_level)) return;
  std::string line = journal ? std::string{'<', priority, '>'} : std::string{};
  line.append(printable(message));
  logger().log(spdlog_level, line);
}

}  // namespace

void start_log(LogLevel level, LogFormat format) {
  journal = goes_to_journal(format);
  logger().set_pattern(journal ? "%v" : "%Y-%m-%d %H:%M:%S.%e %-7l %v");
  set_log_level(level);
}

void set_log_level(LogLevel level) { logger().set_level(level_of(level)); }

void log_debug(std::string_view message) { write(LogLevel::kDebug, '7', message); }
void log_info(std::string_view message) { write(LogLevel::kInfo, '6', message); }
void log_warning(std::string_view message) { write(LogLevel::kWarning, '4', message); }
void log_error(std::string_view message) { write(LogLevel::kError, '3', message); }

}  // namespace warren
