// SPDX-License-Identifier: Apache-2.0
#include "tools/warrenctl/fleet_cli.hpp"

#include <CLI/CLI.hpp>

namespace warren {

FleetCli::FleetCli(CLI::App& app, CLI::App& fleet) {
  add_messages(app);
  const char* const kLayerOrNode =
      "A node's name: all its layers, later ones too; or a layer: the beginning of its id, or its "
      "file";
  retract_ = add_order(fleet, "retract",
                       "Take layers out of everybody's merge-map; of a base alone", kLayerOrNode);
  restore_ = add_order(fleet, "restore", "Put them back; of a base alone", kLayerOrNode);
  clear_ = add_order(fleet, "clear",
                     "Retract all that a node has written so far, not what it begins later; of a "
                     "base alone",
                     "The node's name");
  trajectory_ = fleet.add_subcommand("trajectory", "Where a node's sensor was, in the fleet frame");
  trajectory_->add_option("NODE", subject_, "The node's name")->required();
  trajectory_->add_flag("--json", json_, "An object per line instead of columns");
  add_align(app);
}

void FleetCli::add_messages(CLI::App& app) {
  auto* const message =
      app.add_subcommand("message", "Messages of applications")->require_subcommand(1);
  send_command_ = message->add_subcommand("send", "To another node, or to all others");
  auto* const to = send_command_->add_option("--to", send_.to, "The node's name");
  send_command_->add_flag("--all", to_all_, "To all others, as without --to")->excludes(to);
  send_command_->add_option("--class", class_, "Urgent ones go before the rest")
      ->check(CLI::IsMember({"urgent", "normal"}))
      ->capture_default_str();
  send_command_->add_option("--name", send_.key, "Of one name and receiver only the latest counts");
  auto* const text = send_command_->add_option("TEXT", send_.text);
  auto* const file = send_command_->add_option("--file", send_.file, "What to send, in its place");
  file->excludes(text)->check(CLI::ExistingFile);
  send_command_->callback([text, file] {
    if (text->count() == 0 && file->count() == 0) throw CLI::RequiredError("TEXT or --file");
  });
  watch_command_ = message->add_subcommand("watch", "What has come, and what comes");
  watch_command_->add_flag("--json", watch_.json,
                           "An object per line; content_base64 holds the bytes");
  watch_.seconds = 1'000'000;
  watch_command_->add_option("--seconds", watch_.seconds, "Stop after so long; 0: at once")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
}

CLI::App* FleetCli::add_order(CLI::App& fleet, const char* name, const char* text,
                              const char* subject) {
  auto* const command = fleet.add_subcommand(name, text);
  command->add_option("WHAT", subject_, subject)->required();
  return command;
}

void FleetCli::add_align(CLI::App& app) {
  align_ =
      app.add_subcommand("align", "Shift and turn a layer in everybody's map; of a base alone");
  align_
      ->add_option("WHAT", subject_,
                   "A node's name: its newest layer; or, but not with --estimate, a layer: the "
                   "beginning of its id")
      ->required();
  auto* const shift =
      align_
          ->add_option("SHIFT", shift_,
                       "x y z, metres of the fleet frame, and yaw, degrees about the layer's "
                       "origin; in place of an earlier one: 0 0 0 0 undoes it")
          ->expected(4);
  auto* const estimate =
      align_->add_flag("--estimate", estimate_, "Propose a shift, and move nothing");
  estimate->excludes(shift);
  align_
      ->add_option("--against", against_, "With --estimate: fit it to this node's layer, not ours")
      ->needs(estimate);
  align_->add_flag("--json", json_, "With --estimate: one JSON object")->needs(estimate);
  align_->callback([this] {
    if (!estimate_ && shift_.size() != 4) {
      throw CLI::ValidationError("align", "SHIFT needs x y z yaw, or give --estimate");
    }
  });
}

std::optional<FleetCommand> FleetCli::parsed() const {
  using What = FleetOrderCommand::What;
  if (send_command_->parsed()) {
    MessageSendCommand send = send_;
    send.urgent = class_ == "urgent";
    return send;
  }
  if (watch_command_->parsed()) return watch_;
  if (retract_->parsed()) return FleetOrderCommand{What::kRetract, subject_, {}, 0.0};
  if (restore_->parsed()) return FleetOrderCommand{What::kRestore, subject_, {}, 0.0};
  if (clear_->parsed()) return FleetOrderCommand{What::kClear, subject_, {}, 0.0};
  if (trajectory_->parsed()) return TrajectoryCommand{subject_, json_};
  if (!align_->parsed()) return std::nullopt;
  if (estimate_) return AlignEstimateCommand{subject_, against_, json_};
  return FleetOrderCommand{What::kAlign, subject_, {shift_[0], shift_[1], shift_[2]}, shift_[3]};
}

}  // namespace warren
