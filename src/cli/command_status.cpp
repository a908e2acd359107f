// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <iostream>
#include <optional>

#include <meshfarm/report/live_page.hpp>
#include <meshfarm/report/status.hpp>
#include <meshfarm/report/status_screen.hpp>
#include <meshfarm/transport/page_server.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/signal_wait.hpp"
#include "cli/stage_watch.hpp"
#include "cli/terminal_screen.hpp"

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_refresh_every{1000};
constexpr std::chrono::milliseconds k_look_for_keys_every{200};
/// A log gets at most one line per this many looks, and one for each change of the phase.
constexpr int k_looks_a_line = 5;

class StatusCommand : public Command {
 public:
  std::string_view name() const override { return "status"; }
  std::string_view synopsis() const override { return "STAGE [--watch | --serve PORT]"; }
  std::string_view summary() const override {
    return "show the progress of a stage's run and what each worker is doing";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "watch", po::bool_switch(&watch_),
        "watch until the run is over: on a screen redrawn every second (q quits), or as lines if "
        "the output is not a terminal")(
        "serve", po::value<int>()->value_name("PORT")->notifier([this](int port) { port_ = port; }),
        "serve a page for browsers on this host at http://localhost:PORT (0: any free port), until "
        "interrupted")("json", po::bool_switch(&json_),
                       "as JSON (with --watch: one object after another)");
    positional.add("stage", 1);
  }
  void check() override {
    if (port_ && (watch_ || json_))
      throw UsageError("--serve cannot be combined with --watch or --json");
    if (port_ && (*port_ < 0 || *port_ > 65535)) throw UsageError("--serve: a port is 0 to 65535");
  }
  int run() override {
    const Stage stage = Stage::open(stage_);
    if (port_) return serve(stage);
    if (!watch_) {
      std::cout << render(StageLook(stage, stage_).look(), format());
      return 0;
    }
    const SignalWait signals;
    const StageWatch watch(stage, stage_);
    if (json_) return print_objects(watch, signals);
    return TerminalScreen::is_there() ? show(watch, signals) : print_lines(watch, signals);
  }

 private:
  Format format() const { return json_ ? Format::json : Format::text; }

  /// Waits a second. Returns whether to go on.
  static bool goes_on(const SignalWait& signals) {
    const auto end = std::chrono::steady_clock::now() + k_refresh_every;
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      if (left.count() <= 0) return true;
      const std::optional<int> signal = signals.next(left);
      if (signal && SignalWait::ends(*signal)) return false;
      if (signal == SIGTSTP) signals.stop();
    }
  }

  int serve(const Stage& stage) const {
    const SignalWait signals;
    const StageWatch watch(stage, stage_);
    const PageServer server(
        static_cast<std::uint16_t>(*port_),
        [&](const std::string& path) -> std::optional<ServedPage> {
          if (path == "/") return ServedPage{"text/html", render_live_page()};
          if (path != "/status.json") return std::nullopt;
          return ServedPage{"application/json", render(watch.facts(), Format::json)};
        });
    std::cout << "http://localhost:" << server.port() << std::endl;
    while (goes_on(signals)) {
    }
    return 0;
  }

  static int print_objects(const StageWatch& watch, const SignalWait& signals) {
    for (;;) {
      const StatusFacts facts = watch.facts();
      std::cout << render(facts, Format::json) << std::flush;
      if (facts.over || !std::cout || !goes_on(signals)) return 0;
    }
  }

  static int print_lines(const StageWatch& watch, const SignalWait& signals) {
    std::string phase;
    for (int looks = 0;; ++looks) {
      const StatusFacts facts = watch.facts();
      if (facts.over) {
        std::cout << render(facts, Format::text) << std::flush;
        return 0;
      }
      const std::string what = facts.phase.substr(0, facts.phase.find_first_of("0123456789"));
      if (what != phase || looks % k_looks_a_line == 0) {
        std::cout << status_line(facts) << std::flush;
        phase = what;
      }
      if (!std::cout || !goes_on(signals)) return 0;
    }
  }

  static int show(const StageWatch& watch, const SignalWait& signals) {
    std::optional<TerminalScreen> screen(std::in_place);
    const Letters letters = TerminalScreen::letters();
    StatusFacts facts = watch.facts();
    while (!facts.over) {
      screen->show(frame_of(status_screen(facts, screen->size(), letters)));
      if (!stays(*screen, signals)) return 0;
      facts = watch.facts();
    }
    screen.reset();
    std::cout << render(facts, Format::text) << std::flush;
    return 0;
  }

  /// Waits until it is time for the next frame. Returns whether to show one.
  static bool stays(TerminalScreen& screen, const SignalWait& signals) {
    const auto end = std::chrono::steady_clock::now() + k_refresh_every;
    while (std::chrono::steady_clock::now() < end) {
      const std::optional<int> signal = signals.next(k_look_for_keys_every);
      if (screen.quit_was_pressed()) return false;
      if (!signal) continue;
      if (SignalWait::ends(*signal)) return false;
      if (signal == SIGTSTP) {
        screen.leave();
        signals.stop();
      }
      screen.enter();  // if it was left
      return true;     // the size or the screen has changed
    }
    return true;
  }

  std::string stage_;
  std::optional<int> port_;
  bool watch_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_status_command() {
  return std::make_unique<StatusCommand>();
}

}  // namespace meshfarm
