// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include <meshfarm/report/live_page.hpp>
#include <meshfarm/report/status_screen.hpp>

namespace meshfarm {
namespace {

/// Half done, by two workers, one of them twice as fast.
StatusFacts facts_for_screen() {
  StatusFacts facts;
  facts.stage = "dragon.stage";
  facts.input = "dragon.ply";
  facts.triangles = 871'414;
  facts.parts = 16;
  facts.free_bytes = std::uint64_t{3} << 30;
  facts.has_run = facts.works = true;
  facts.head.epoch = 2;
  facts.head.host = "here";
  facts.phase = "simplifying";
  facts.rate = 1.2e6;
  facts.eta_s = 15;
  facts.state.jobs_known = 16;
  facts.state.jobs_done = 8;
  facts.state.triangles_known = 1000;
  facts.state.triangles_done = 999;
  facts.state.stages = {{"climb", 16, 8}};
  facts.workers.resize(2);
  facts.workers[0] = {{.worker = 1, .host = "fast", .pid = 11}, {.worker = 1, .held = 2}, 6, 0};
  facts.workers[1] = {{.worker = 2, .host = "slow", .pid = 12}, {.worker = 2, .held = 1}, 3, 0};
  return facts;
}

std::string text_of_screen(const StatusFacts& facts, const ScreenSize& size, Letters letters) {
  std::string text;
  for (const ScreenLine& each : status_screen(facts, size, letters)) text += each.text + "\n";
  return text;
}

bool screen_has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a screen shows how far a run is, its stages, and what each worker did and holds") {
  const std::string text = text_of_screen(facts_for_screen(), {111, 40}, Letters::ascii);
  CHECK(screen_has(text, "epoch 2 on here"));
  CHECK(screen_has(text, "1.2 M triangles/s, farm done in 15 s, room 3.0 GiB on the stage"));
  CHECK(screen_has(text, "jobs 8 of 16 done"));
  CHECK(screen_has(text, ".  99 %"));  // rounded down, and its bar is not full
  CHECK(screen_has(text, "climb"));
  CHECK(screen_has(text, "fast:11"));
  const auto count = [&](char c) { return std::count(text.begin(), text.end(), c); };
  CHECK(count('=') > 0);  // jobs held by workers
  CHECK(count('#') > 0);
}

TEST_CASE("no line of a screen is wider than it, and there are no more than it has") {
  StatusFacts facts = facts_for_screen();
  facts.phase = std::string(300, 'x');
  facts.workers.resize(50, facts.workers[0]);
  for (const std::size_t columns : {1, 2, 20, 60, 80, 200}) {
    for (const std::size_t rows : {1, 5, 12, 24}) {
      for (const Letters letters : {Letters::ascii, Letters::unicode}) {
        CAPTURE(columns);
        CAPTURE(rows);
        const auto lines = status_screen(facts, {columns, rows}, letters);
        CHECK(lines.size() <= rows);
        for (const ScreenLine& line : lines) {
          const auto width = std::count_if(line.text.begin(), line.text.end(),
                                           [](char c) { return (c & 0xC0) != 0x80; });
          CHECK(static_cast<std::size_t>(width) <= std::max<std::size_t>(1, columns - 1));
        }
      }
    }
  }
  CHECK(screen_has(text_of_screen(facts, {80, 24}, Letters::ascii), "and 4"));
}

TEST_CASE("what names hold does not reach the terminal as commands") {
  StatusFacts facts = facts_for_screen();
  facts.stage = "a\x1b[2Jb";
  facts.workers[0].joined.host =
      "h\xc2\x9b"
      "2J\r\n";
  facts.problem = "\x07";
  const std::string text = text_of_screen(facts, {100, 40}, Letters::ascii);
  CHECK(screen_has(text, "a?[2Jb"));
  CHECK(std::all_of(text.begin(), text.end(),
                    [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
}

TEST_CASE("a frame replaces the one before without a moment in which nothing is there") {
  const std::string frame =
      frame_of({{"one", ScreenLine::Look::plain}, {"two", ScreenLine::Look::strong}});
  CHECK(frame == "\x1b[Hone\x1b[K\r\n\x1b[1mtwo\x1b[0m\x1b[K\x1b[J");
}

TEST_CASE("a status that grows old without news promises nothing") {
  const StatusFacts fresh = grown_older(facts_for_screen(), 1, "");
  CHECK(fresh.eta_s == 14);
  CHECK(fresh.works);
  const StatusFacts old = grown_older(facts_for_screen(), 30, "cannot list");
  CHECK(old.eta_s < 0);
  CHECK(old.rate == 0);
  CHECK(old.warns);
  CHECK(screen_has(old.phase, "could not be looked at for 30 s"));
  const std::string line = status_line(old);
  CHECK(screen_has(line, "cannot list"));
  CHECK_FALSE(screen_has(line, "triangles/s"));
  StatusFacts over = facts_for_screen();
  over.over = true;
  over.phase = "done";
  CHECK(grown_older(over, 1000, "").phase == "done");
  CHECK(status_line(over).starts_with("done"));
}

TEST_CASE("the live page is whole and loads nothing") {
  const std::string page = render_live_page();
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK(page.ends_with("</html>\n"));
  CHECK_FALSE(screen_has(page, "http"));
  CHECK_FALSE(screen_has(page, "src="));
}

}  // namespace
}  // namespace meshfarm
