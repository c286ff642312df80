// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/message_watch.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <iostream>
#include <thread>

#include <nlohmann/json.hpp>

#include "daemon/printable.hpp"
#include "tools/warrenctl/ask.hpp"
#include "warren/control.pb.h"

namespace warren {
namespace {

constexpr std::chrono::milliseconds kEvery{200};
constexpr std::int64_t kMicrosPerSecond = 1'000'000;

std::string base64_of(const std::string& bytes) {
  static constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < left ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= left ? kDigits[group >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

std::string time_of_day(std::int64_t us) {
  const std::time_t seconds = us / kMicrosPerSecond;
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 16> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%H:%M:%S", &local)};
}

void print(const control::ReceivedMessage& message, bool json) {
  const bool urgent = message.message_class() == control::URGENT;
  if (json) {
    nlohmann::ordered_json object;
    object["number"] = message.number();
    object["from"] = message.from();
    object["to_all"] = message.to_all();
    object["class"] = urgent ? "urgent" : "normal";
    object["name"] = message.key();
    object["time_us"] = message.time_us();
    object["content_base64"] = base64_of(message.content());
    std::cout << object.dump() << std::endl;  // is watched live
    return;
  }
  std::cout << time_of_day(message.time_us()) << " " << message.from()
            << (message.to_all() ? " to all" : "") << (urgent ? " (urgent)" : "")
            << (message.key().empty() ? "" : " [" + message.key() + "]") << ": "
            << printable(message.content()) << std::endl;
}

}  // namespace

int watch_messages(const MessageWatchCommand& command, const std::string& socket) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(command.seconds);
  control::Request request;
  auto& question = *request.mutable_message_watch();
  while (true) {
    const auto response = ask_daemon(socket, request);
    if (!response) {
      std::cerr << "warrenctl: " << response.error() << "\n";
      return 1;
    }
    const control::Messages& came = response->messages();
    if (came.missed() > 0) {
      std::cerr << "warrenctl: " << came.missed() << " earlier messages are not kept any more\n";
    }
    for (const auto& message : came.messages()) print(message, command.json);
    question.set_inbox(came.inbox());
    question.set_after(came.next());
    // The last question says that all of it has arrived here.
    if (came.more() || came.messages_size() > 0) continue;
    if (Clock::now() >= end) return 0;
    std::this_thread::sleep_for(kEvery);
  }
}

}  // namespace warren
