// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <boost/program_options.hpp>
#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

using namespace meshfarm;

namespace {

using Words = std::vector<std::string>;

/// The group that `add` declares, filled from a command line and checked.
template <typename Group, typename Add>
Group parse(const Words& words, const Add& add) {
  Group group;
  po::options_description described;
  add(group, described);
  po::variables_map values;
  po::store(po::command_line_parser(words).options(described).run(), values);
  po::notify(values);
  group.check();
  return group;
}

template <typename Group>
Group parse(const Words& words) {
  return parse<Group>(words, [](Group& group, auto& described) { group.add(described); });
}

TargetOptions target_of(const Words& words) {
  return parse<TargetOptions>(words, [](TargetOptions& group, auto& described) {
    group.add(described);
    group.add_attributes(described);
  });
}

/// The usage error for these words; empty if they are accepted.
template <typename Parse>
std::string error_of(const Words& words, const Parse& parse_words) {
  try {
    parse_words(words);
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

bool tells(const std::string& error, std::string_view part) {
  return error.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("sizes have units that are powers of 1024") {
  CHECK(parse_size("0", "--memory") == 0);
  CHECK(parse_size("17", "--memory") == 17);
  CHECK(parse_size("3K", "--memory") == 3 * 1024);
  CHECK(parse_size("512M", "--memory") == 512ULL << 20);
  CHECK(parse_size("1.5G", "--memory") == 3ULL << 29);
  CHECK(parse_size("2T", "--memory") == 2ULL << 40);
  for (const char* wrong : {"", "G", "8GB", "8 G", "-1", "nan", "inf", "0x10", "9999999T", "8g"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(parse_size(wrong, "--memory"), UsageError);
  }
}

TEST_CASE("a target is one of a ratio, a count and an error") {
  CHECK(target_of({"--ratio", "0.25"}).run.ratio == 0.25);
  CHECK(target_of({"--triangles", "12"}).run.triangles == 12);
  CHECK(target_of({"--ratio", "1"}).run.ratio == 1);
  CHECK(target_of({"--ratio", "12.5%"}).run.ratio == 0.125);
  const Words wrong[] = {{},
                         {"--ratio", "0.1", "--triangles", "5"},
                         {"--ratio", "0.1", "--error", "1"},
                         {"--ratio", "1.01"},
                         {"--ratio", "101%"},
                         {"--ratio", "0%"},
                         {"--ratio", "%"},
                         {"--ratio", "-0.1"},
                         {"--ratio", "nan"},
                         {"--error", "0"},
                         {"--error", "0%"}};
  for (const Words& words : wrong) {
    CAPTURE(words.size());
    CHECK(error_of(words, target_of) != "");
  }
}

TEST_CASE("lengths are in the mesh's unit or a share of its diagonal") {
  const Length unit = target_of({"--error", "2.5"}).run.error;
  CHECK(unit.value == 2.5);
  CHECK(!unit.of_diagonal);
  const Length share = target_of({"--error", "0.1%"}).run.error;
  CHECK(share.value == doctest::Approx(0.001));
  CHECK(share.of_diagonal);
  CHECK(target_of({"--ratio", "0.1", "--drop-components", "0"}).run.drop_components.value == 0);
  for (const char* length : {"%", "1%%", "1 %", "-1", "inf", "nan%", "1mm"}) {
    CAPTURE(length);
    const Words words = {"--ratio=0.1", "--drop-components=" + std::string(length)};
    CHECK(tells(error_of(words, target_of), "--drop-components"));
  }
}

TEST_CASE("words that name no choice are told with the choices") {
  const auto check = [](const char* option, const char* choices) {
    const std::string error = error_of({"--ratio=0.1", std::string(option) + "=most"}, target_of);
    CAPTURE(option);
    CHECK(tells(error, option));
    CHECK(tells(error, choices));
    CHECK(tells(error, "'most'"));
  };
  check("--allocation", "'threshold' or 'uniform'");
  check("--finish", "'auto', 'here', 'farm' or 'boundary'");
  check("--composition", "'auto', 'tree' or 'sink'");
  check("--fit", "'auto', 'on' or 'off'");
  check("--topology", "'auto', 'keep' or 'simplify'");
  check("--crossings", "'allow' or 'avoid'");
  check("--normals", "'blend', 'recompute' or 'drop'");
}

TEST_CASE("the finish has an older name, and one way that is the paper's") {
  CHECK(target_of({"--ratio=0.1"}).run.finish_place == FinishPlace::automatic);
  CHECK(target_of({"--ratio=0.1", "--finish=global"}).run.finish_place == FinishPlace::here);
  CHECK(target_of({"--ratio=0.1", "--finish=farm"}).run.finish_place == FinishPlace::farm);
  const RunOptions paper = target_of({"--ratio=0.1", "--finish=boundary"}).run;
  CHECK(paper.finish == Finish::boundary);
  CHECK(paper.finish_place == FinishPlace::here);
}

TEST_CASE("a proof needs a bound, of the whole input") {
  CHECK(target_of({"--error=1", "--certify"}).run.certify);
  CHECK(tells(error_of({"--ratio=0.1", "--certify"}, target_of), "--certify"));
  CHECK(tells(error_of({"--error=1", "--certify", "--drop-components=1"}, target_of), "--certify"));
}

TEST_CASE("a tree has one threshold for all parts") {
  CHECK(error_of({"--ratio=0.1", "--composition=tree"}, target_of).empty());
  CHECK(tells(error_of({"--error=1", "--composition=tree"}, target_of), "--composition tree"));
  CHECK(tells(error_of({"--ratio=0.1", "--composition=tree", "--allocation=uniform"}, target_of),
              "--composition tree"));
  CHECK(tells(error_of({"--ratio=0.1", "--composition=tree", "--finish=boundary"}, target_of),
              "--composition tree"));
}

TEST_CASE("vertices are not fitted with options that they would go against") {
  CHECK(error_of({"--ratio=0.1", "--fit=on"}, target_of).empty());
  for (const Words& line :
       {Words{"--error=1"}, Words{"--ratio=0.1", "--crossings=avoid"},
        Words{"--ratio=0.1", "--finish=boundary"}, Words{"--ratio=0.1", "--drop-components=1"}}) {
    Words on = line;
    on.emplace_back("--fit=on");
    CAPTURE(line.back());
    CHECK(error_of(line, target_of).empty());
    CHECK(tells(error_of(on, target_of), "--fit on"));
  }
}

TEST_CASE("angles and picture sizes have limits") {
  CHECK(target_of({"--ratio=0.1", "--crease-angle=40"}).run.lines.crease_angle == 40);
  CHECK(error_of({"--ratio=0.1", "--crease-angle=180"}, target_of) != "");
  CHECK(error_of({"--ratio=0.1", "--crease-angle=-1"}, target_of) != "");
  CHECK(target_of({"--ratio=0.1", "--texture-size=64"}).run.texture_size == 64);
  CHECK(error_of({"--ratio=0.1", "--texture-size=63"}, target_of) != "");
  CHECK(error_of({"--ratio=0.1", "--texture-size=16385"}, target_of) != "");
}

TEST_CASE("a target's words say all of it again") {
  const Words lines[] = {
      {"--ratio=0.125"},
      {"--triangles=7", "--allocation=uniform", "--finish=boundary", "--composition=sink"},
      {"--error=0.1%", "--topology=keep", "--crossings=avoid", "--preserve-border",
       "--crease-angle=30.5"},
      {"--ratio=0.1", "--drop-components=2%", "--weight=colour=0.01", "--normals=recompute"},
      {"--ratio=0.1", "--attributes=none", "--uv=bake", "--texture-size=1024", "--fit=off"}};
  for (const Words& line : lines) {
    CAPTURE(line.back());
    const TargetOptions first = target_of(line);
    const TargetOptions again = target_of(first.words());
    CHECK(first.words() == again.words());
    CHECK(first.run.ratio == again.run.ratio);
    CHECK(first.run.triangles == again.run.triangles);
    CHECK(first.run.error.value == again.run.error.value);
    CHECK(first.run.error.of_diagonal == again.run.error.of_diagonal);
    CHECK(first.run.allocation == again.run.allocation);
    CHECK(first.run.finish == again.run.finish);
    CHECK(first.run.composition == again.run.composition);
    CHECK(first.run.fit == again.run.fit);
    CHECK(first.run.lines.topology == again.run.lines.topology);
    CHECK(first.run.lines.crossings == again.run.lines.crossings);
    CHECK(first.run.lines.preserve_border == again.run.lines.preserve_border);
    CHECK(first.run.lines.crease_angle == again.run.lines.crease_angle);
    CHECK(first.run.drop_components.value == again.run.drop_components.value);
    CHECK(first.run.colour_weight == again.run.colour_weight);
    CHECK(first.run.normals == again.run.normals);
    CHECK(first.run.textures == again.run.textures);
    CHECK(first.run.texture_size == again.run.texture_size);
  }
}

TEST_CASE("a cut's words say all of it again, and limits are told") {
  const CutWords plain = parse<CutWords>({});
  CHECK(plain.cut.scheme == Scheme::cut);
  CHECK(plain.cut.weld == Weld::exact);
  CHECK(plain.cut.sort == SortAt::here);
  const CutWords all =
      parse<CutWords>({"--scheme=stream", "--sort=farm", "--weld=off", "--parts=12", "--threads=3",
                       "--memory=1G", "--window=2000", "--scratch=/x", "--attributes=none"});
  const CutWords again = parse<CutWords>(all.words());
  CHECK(all.words() == again.words());
  CHECK(again.cut.scheme == Scheme::stream);
  CHECK(again.cut.sort == SortAt::farm);
  CHECK(again.cut.weld == Weld::off);
  CHECK(again.cut.parts == 12);
  CHECK(again.cut.threads == 3);
  CHECK(again.cut.memory_bytes == 1ULL << 30);
  CHECK(again.cut.window_triangles == 2000);
  CHECK(again.cut.scratch == "/x");
  CHECK(plain.weld_distance.value == 0);
  CHECK(again.weld_distance.value == 0);
  const CutWords near = parse<CutWords>({"--weld=0.01%"});
  CHECK(near.cut.weld == Weld::exact);
  CHECK(near.weld_distance.value == 0.0001);
  CHECK(near.weld_distance.of_diagonal);
  CHECK(parse<CutWords>(near.words()).words() == near.words());
  CHECK(error_of({"--weld=0.5", "--cut=farm"}, parse<CutWords>) != "");
  for (const char* wrong : {"--scheme=both", "--sort=there", "--sort=farm", "--weld=near",
                            "--parts=1000001", "--window=999", "--memory=0", "--uv=some"}) {
    CAPTURE(wrong);
    CHECK(error_of({wrong}, parse<CutWords>) != "");
  }
}

TEST_CASE("what is insecure is asked for by name") {
  const SecurityWords plain = parse<SecurityWords>({});
  CHECK(plain.security.authentication == Authentication::curve);
  const SecurityWords open = parse<SecurityWords>({"--insecure", "--insecure-network"});
  CHECK(open.security.authentication == Authentication::none);
  CHECK(open.security.insecure_exposure == Exposure::network);
  CHECK(parse<SecurityWords>(open.words()).words() == open.words());
  CHECK(parse<SecurityWords>({"--insecure"}).security.insecure_exposure == Exposure::loopback_only);
  CHECK(error_of({"--insecure-network"}, parse<SecurityWords>) != "");
  CHECK(error_of({"--insecure", "--key-file=k"}, parse<SecurityWords>) != "");
}

TEST_CASE("ports are a range") {
  const NetworkOptions one = parse<NetworkOptions>({"--bind=127.0.0.1", "--ports=7000-7000"});
  CHECK(one.first_port == 7000);
  CHECK(one.last_port == 7000);
  CHECK(parse<NetworkOptions>(one.words()).words() == one.words());
  for (const char* wrong : {"7000", "7001-7000", "0-5", "1-65536", "a-b", "1-", "-1", "1-2-3"}) {
    CAPTURE(wrong);
    CHECK(error_of({"--bind=127.0.0.1", "--ports=" + std::string(wrong)}, parse<NetworkOptions>) !=
          "");
  }
}

TEST_CASE("schedules have words of their own") {
  const ScheduleWords fixed = parse<ScheduleWords>({"--schedule=static", "--expect-workers=4"});
  CHECK(fixed.options.schedule == Schedule::fixed);
  CHECK(fixed.options.expect_workers == 4);
  CHECK(parse<ScheduleWords>(fixed.words()).words() == fixed.words());
  for (const char* wrong : {"--schedule=lazy", "--hang-seconds=0", "--hang-seconds=86401"}) {
    CHECK(error_of({wrong}, parse<ScheduleWords>) != "");
  }
}

TEST_CASE("the simulator's threads have memory of their own") {
  CHECK_FALSE(make_simulate_command()->keeps_freed_memory());
  CHECK(make_simplify_command()->keeps_freed_memory());
}
