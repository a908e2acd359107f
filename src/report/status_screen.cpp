// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/status_screen.hpp>
#include <meshfarm/util/text.hpp>

#include "report/lines.hpp"

namespace meshfarm {
namespace {

using Look = ScreenLine::Look;

constexpr std::size_t k_widest = 110;  // maximum useful width in columns
constexpr std::size_t k_stage_name = 14;
constexpr std::size_t k_host_name = 24;

bool goes_on(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80;  // a UTF-8 continuation byte
}

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !goes_on(c); }));
}

/// Names come from files, and a terminal would execute control codes in them. That includes C1
/// codes (0x80 to 0x9f, preceded by 0xc2 in UTF-8), so only ASCII is kept in text that is not ours.
std::string tame(const std::string& name) {
  std::string made = name;
  for (char& c : made) {
    if (c < ' ' || c > '~') c = '?';
  }
  return made;
}

/// The text cut to this many columns.
std::string fitted(const std::string& text, std::size_t columns) {
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!goes_on(text[i]) && ++width > columns) return text.substr(0, i);
  }
  return text;
}

std::string left_in(std::string text, std::size_t columns) {
  text = fitted(text, columns);
  return text + std::string(columns - width_of(text), ' ');
}

std::string right_in(std::string text, std::size_t columns) {
  text = fitted(text, columns);
  return std::string(columns - width_of(text), ' ') + text;
}

struct BarParts {
  double done = 0;  // fraction of the bar's length, from 0 to 1
  double held = 0;
};

/// A bar of done and held work: full only when everything is done.
std::string bar_of(const BarParts& parts, std::size_t columns, Letters letters) {
  const auto all = static_cast<double>(columns);
  const auto cells = [&](double share) {
    return static_cast<std::size_t>(std::floor(std::clamp(share, 0.0, 1.0) * all + 1e-9));
  };
  const std::size_t done = cells(parts.done);
  const std::size_t held = std::max(done, cells(parts.done + parts.held));
  const bool plain = letters == Letters::ascii;
  std::string bar;
  for (std::size_t i = 0; i < columns; ++i) {
    if (i < done) {
      bar += plain ? "#" : "█";
    } else if (i < held) {
      bar += plain ? "=" : "▒";
    } else {
      bar += plain ? "." : "░";
    }
  }
  return bar;
}

double part_of(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
}

std::string percent(double share) {
  return number(std::floor(100 * share + 1e-9), "%.0f %%");
}

class ScreenWriter {
 public:
  ScreenWriter(const StatusFacts& facts, const ScreenSize& size, Letters letters)
      : facts_(facts),
        rows_(size.rows),
        all_columns_(std::max<std::size_t>(size.columns, 2) - 1),
        columns_(std::min(k_widest, all_columns_)),
        letters_(letters) {}

  std::vector<ScreenLine> write() {
    add_head();
    if (facts_.has_run) {
      add_progress();
      add_stages();
      add_workers();
    }
    if (lines_.size() > rows_) lines_.resize(rows_);
    return std::move(lines_);
  }

 private:
  void add(const std::string& text, Look look = Look::plain) {
    lines_.push_back({fitted(text, all_columns_), look});
  }

  void add_head() {
    add(tame(facts_.stage), Look::strong);
    add(tame(facts_.input) + ", " + grouped(facts_.triangles) + " triangles in " +
            grouped(facts_.parts) + " parts",
        Look::dim);
    if (facts_.has_run) {
      add("epoch " + std::to_string(facts_.head.epoch) + " on " + tame(facts_.head.host) +
              ", for " + duration_text(facts_.elapsed_s),
          Look::dim);
    }
    add("");
    add((facts_.has_run ? "" : "runs: ") + tame(facts_.phase),
        facts_.warns ? Look::warning : Look::strong);
    if (!facts_.problem.empty()) add(tame(facts_.problem), Look::warning);
  }

  void add_progress() {
    const TraceState& s = facts_.state;
    if (s.jobs_known == 0) return;  // the amount of work, and how much is done, is not known yet
    const double share = part_of(s.triangles_done, s.triangles_known);
    const std::string about = " " + right_in(percent(share), 5);
    add(bar_of({share, 0}, columns_ > about.size() ? columns_ - about.size() : 0, letters_) +
        about);
    std::vector<std::string> words;
    if (facts_.rate > 0) words.push_back(with_unit(facts_.rate) + " triangles/s");
    if (facts_.eta_s >= 0) words.push_back("farm done in " + duration_text(facts_.eta_s));
    if (facts_.free_bytes) words.push_back("room " + gib(*facts_.free_bytes) + " on the stage");
    add(joined(words));
    add("jobs " + grouped(s.jobs_done) + " of " + grouped(s.jobs_known) + " done, " +
        grouped(s.jobs_running) + " running, " + grouped(s.jobs_failed) + " failed, " +
        grouped(s.retries) + " retried");
    if (!s.bad_hosts.empty()) {
      add("no more jobs for " + tame(joined(s.bad_hosts)) + ": too many failed there",
          Look::warning);
    }
  }

  void add_stages() {
    if (facts_.state.stages.empty()) return;
    add("");
    for (const TraceState::Stage& each : facts_.state.stages) {
      const std::string count = grouped(each.done) + " of " + grouped(each.jobs);
      const std::size_t beside = k_stage_name + 2 + 16;
      const std::size_t bar = columns_ > beside ? columns_ - beside : 0;
      add(left_in(tame(each.stage), k_stage_name) + " " +
          bar_of({part_of(each.done, each.jobs), 0}, bar, letters_) + " " + right_in(count, 16));
    }
  }

  /// Bars are scaled to what the busiest worker did and holds.
  void add_workers() {
    add("");
    add("workers " + grouped(facts_.workers.size()) + ", " + grouped(facts_.workers_left) +
        " left or were lost");
    if (facts_.workers.empty()) return;
    const std::string figures = right_in("jobs", 7) + right_in("held", 6) +
                                right_in("triangles/s", 13) + right_in("memory", 12) +
                                right_in("heard of", 11);
    const std::size_t beside = 5 + k_host_name + 1 + figures.size();
    bar_columns_ = columns_ > beside + 8 ? columns_ - beside : 0;
    add(right_in("#", 3) + "  " + left_in("host", k_host_name) + " " +
            left_in("done and held", bar_columns_) + figures,
        Look::dim);
    std::uint64_t most = 1;
    for (const WorkerFacts& each : facts_.workers) {
      most = std::max(most, each.done + each.state.held);
    }
    const std::size_t shown = room_for(facts_.workers.size());
    for (std::size_t i = 0; i < shown; ++i) add_worker(facts_.workers[i], most);
    if (shown < facts_.workers.size()) {
      add("     and " + grouped(facts_.workers.size() - shown) + " more", Look::dim);
    }
  }

  std::size_t room_for(std::size_t workers) const {
    const std::size_t left = rows_ > lines_.size() ? rows_ - lines_.size() : 0;
    return workers <= left ? workers : std::max<std::size_t>(left, 1) - 1;
  }

  void add_worker(const WorkerFacts& w, std::uint64_t most) {
    const std::string bar =
        bar_of({part_of(w.done, most), part_of(w.state.held, most)}, bar_columns_, letters_);
    const std::string host = tame(w.joined.host) + ":" + std::to_string(w.joined.pid);
    add(right_in(std::to_string(w.state.worker), 3) + "  " + left_in(host, k_host_name) + " " +
        bar + right_in(grouped(w.done), 7) + right_in(std::to_string(w.state.held), 6) +
        right_in(with_unit(w.state.speed), 13) + right_in(mib(w.state.rss_bytes), 12) +
        right_in(number(w.state.silent_s, "%.0f s ago"), 11));
  }

  const StatusFacts& facts_;
  std::size_t rows_;
  std::size_t all_columns_;  // except the last: a terminal may wrap there, or erase it
  std::size_t columns_;      // width of bars
  std::size_t bar_columns_ = 0;
  Letters letters_;
  std::vector<ScreenLine> lines_;
};

const char* code_of(Look look) {
  switch (look) {
    case Look::strong:
      return "\x1b[1m";
    case Look::dim:
      return "\x1b[2m";
    case Look::warning:
      return "\x1b[33m";
    default:
      return "";
  }
}

}  // namespace

std::vector<ScreenLine> status_screen(const StatusFacts& facts, const ScreenSize& size,
                                      Letters letters) {
  return ScreenWriter(facts, size, letters).write();
}

std::string frame_of(const std::vector<ScreenLine>& lines) {
  std::string frame = "\x1b[H";
  bool is_first = true;
  for (const ScreenLine& each : lines) {
    if (!is_first) frame += "\r\n";
    is_first = false;
    // Erase from the end of the text: the text itself overwrites the previous frame.
    const bool is_plain = each.look == Look::plain;
    frame += code_of(each.look) + each.text + (is_plain ? "\x1b[K" : "\x1b[0m\x1b[K");
  }
  return frame + "\x1b[J";
}

std::string status_line(const StatusFacts& facts) {
  if (!facts.has_run) return "runs: " + facts.phase + "\n";
  const TraceState& s = facts.state;
  std::vector<std::string> words = {tame(facts.phase)};
  if (!facts.over && s.jobs_known > 0) {
    words.push_back(percent(part_of(s.triangles_done, s.triangles_known)));
    words.push_back(grouped(s.jobs_done) + " of " + grouped(s.jobs_known) + " jobs");
    words.push_back(grouped(facts.workers.size()) + " workers");
  }
  if (facts.rate > 0) words.push_back(with_unit(facts.rate) + " triangles/s");
  if (facts.eta_s >= 0) words.push_back("farm done in " + duration_text(facts.eta_s));
  if (!facts.problem.empty()) words.push_back(tame(facts.problem));
  return joined(words) + "\n";
}

}  // namespace meshfarm
