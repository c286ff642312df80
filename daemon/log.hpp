// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace warren {

enum class LogLevel : std::uint8_t { kDebug, kInfo, kWarning, kError, kOff };
// journal: a priority prefix and no time, as systemd's journal wants it. auto: journal if stderr
// goes there, text otherwise.
enum class LogFormat : std::uint8_t { kAuto, kText, kJournal };

// The process's log on stderr. Any thread may write; line breaks and other control characters in
// a message become spaces, so that a client's text cannot forge a line.
void start_log(LogLevel level, LogFormat format);
void set_log_level(LogLevel level);
void log_debug(std::string_view message);
void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);

}  // namespace warren
