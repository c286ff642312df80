// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/subscriptions.hpp"

#include <algorithm>
#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>

#include "daemon/control/response.hpp"
#include "daemon/random_bits.hpp"

namespace warren {

Subscriptions::Subscriptions(asio::io_context& io, Fleet& fleet)
    : io_(io), fleet_(fleet), run_(random_bits()) {}

std::function<void()> Subscriptions::answer(const BlocksQuestion& question,
                                            const Respond& respond) {
  const auto wait = std::make_shared<Wait>(io_, question, respond);
  const std::chrono::duration<double> patience(question.wait_s);
  wait->until = Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
  if (question.cursor && question.cursor->run != run_) wait->question.cursor.reset();
  // Who has a part still to come need not be slowed down.
  const auto& cursor = wait->question.cursor;
  cursor && cursor->is_through() && question.wait_s > 0.0 ? look_later(wait) : look(wait);
  return [wait] {
    wait->is_over = true;
    wait->timer.cancel();
  };
}

void Subscriptions::look_later(const SharedWait& wait) {
  const std::chrono::duration<double> period(1.0 / wait->question.rate_hz);
  const auto next = Clock::now() + std::chrono::duration_cast<Clock::duration>(period);
  wait->timer.expires_at(std::min(next, wait->until));
  wait->timer.async_wait([this, wait](std::error_code) { look(wait); });
}

void Subscriptions::look(const SharedWait& wait) {
  // The wait goes back as it came, so that its end is on this thread.
  const bool asked =
      fleet_.ask([this, wait, question = wait->question,
                  guard = asio::make_work_guard(io_)](const FleetParts& fleet) mutable {
        auto result = fleet.map.blocks(question);
        asio::post(io_, [this, wait = std::move(wait), result = std::move(result)] {
          on_look(wait, result);
        });
      });
  if (!asked) wait->respond(encode_error(kTooManyQuestions));
}

void Subscriptions::on_look(const SharedWait& wait, const Result& result) {
  if (!result) return wait->respond(encode_error(result.error()));
  BlocksAnswer answer = *result;
  answer.cursor.run = run_;
  const bool waits_on = !answer.is_news() && !wait->is_over && Clock::now() < wait->until;
  if (!waits_on) return wait->respond(encode_blocks(answer));
  // What changed outside the box is not looked at again.
  wait->question.cursor = answer.cursor;
  look_later(wait);
}

}  // namespace warren
