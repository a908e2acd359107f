// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/summary.hpp>

using namespace meshfarm;

TEST_CASE("numbers have units that people read") {
  CHECK(with_unit(12) == "12 ");
  CHECK(with_unit(999) == "999 ");
  CHECK(with_unit(999.6) == "1 k");
  CHECK(with_unit(123'456) == "123 k");
  CHECK(with_unit(3'450'000) == "3.5 M");
  CHECK(with_unit(2e9) == "2.0 G");
  CHECK(duration_text(3.4) == "3 s");
  CHECK(duration_text(59.6) == "1 min 0 s");
  CHECK(duration_text(200) == "3 min 20 s");
  CHECK(duration_text(7500) == "2 h 5 min");
}

TEST_CASE("a line has the phase, the share, the rate and the time left") {
  using namespace std::chrono_literals;
  ProgressPrinter printer(ProgressStyle::none);
  const ProgressPrinter::Clock::time_point zero{};
  CHECK(printer.line({.phase = "farm", .done = 0.25, .triangles = 5'000'000}, zero + 10s) ==
        "farm: 25 %, 500 ktriangles/s, 30 s left");
  CHECK(printer.line({.phase = "cut", .done = 0.01, .triangles = 0}, zero + 10s) == "cut: 1 %");
  CHECK(printer.line({.phase = "cut", .done = 1, .triangles = 0}, zero + 10s) == "cut: 100 %");
}

TEST_CASE("a comparison is in fractions of the diagonal") {
  Comparison c;
  c.path_a = "a.ply";
  c.path_b = "b.ply";
  c.diagonal = 10;
  c.a_to_b.distance = {.rms = 0.02, .mean = 0.01, .max = 0.5};
  c.a_to_b.quantiles = {.p95 = 0.3, .p99 = 0.4};
  const std::string text = render(c, Format::text);
  CHECK(text.find("rms 0.002  mean 0.001  95 % 0.03  99 % 0.04  max 0.05") != std::string::npos);
  const std::string json = render(c, Format::json);
  CHECK(json.find("\"rms\": 0.002") != std::string::npos);
}

TEST_CASE("a run's summary says when the count is not the one asked for") {
  RunSummary s;
  s.target = 101;
  s.triangles = 1'234'567;
  CHECK(render(s, Format::text).find("asked for") == std::string::npos);
  s.why_not_exact = "for a reason";
  CHECK(render(s, Format::text)
            .find("101 triangles were asked for, 1,234,567 are left: for a reason") !=
        std::string::npos);
  CHECK(render(s, Format::text).find("1,234,567 triangles") != std::string::npos);
  CHECK(render(s, Format::json).find("\"exact\": false") != std::string::npos);
  s.triangles = 100;
  CHECK(warning_of(s).empty());
  CHECK(render(s, Format::text).find("101 were asked for: for a reason") != std::string::npos);
}

TEST_CASE("a run's summary warns of a result without triangles") {
  RunSummary s;
  CHECK(warning_of(s) == "the result has no triangles");
  CHECK(render(s, Format::json).find("\"warning\": \"the result has no triangles\"") !=
        std::string::npos);
}

TEST_CASE("a run's summary warns of a result that a few triangles more would have saved") {
  RunSummary s;
  s.manifest.box.add({0, 0, 0});
  s.manifest.box.add({0, 0, 10});
  s.target = s.triangles = 4000;
  s.error.to_output.rms = 0.27;
  s.error.input_samples = s.error.output_samples = 1000;
  CHECK(render(s, Format::text).find("warning") == std::string::npos);
  CHECK(render(s, Format::json).find("\"better\": null") != std::string::npos);
  s.better = BetterCount{5200, s.error};
  s.better->error.to_output.rms = 0.0031;
  const std::string warning = "4,000 triangles cost an error of 0.027; 5,200 would have 0.00031";
  CHECK(warning_of(s) == warning);
  CHECK(render(s, Format::text).find("warning          " + warning) != std::string::npos);
  const std::string json = render(s, Format::json);
  CHECK(json.find("\"warning\": \"" + warning) != std::string::npos);
  CHECK(json.find("\"triangles\": 5200") != std::string::npos);
}

TEST_CASE("a run's summary warns of a bound that a sampled point breaks") {
  RunSummary s;
  s.manifest.box.add({0, 0, 0});
  s.manifest.box.add({0, 0, 10});
  s.target = s.triangles = 4000;
  s.max_error = 0.1;
  s.error.input_samples = s.error.output_samples = 1000;
  s.error.to_input.max = 0.1;
  CHECK(warning_of(s).empty());
  s.error.to_input.max = 0.114;
  const std::string warning =
      "the bound of 0.01 is not kept everywhere: 0.0114 at a sampled point; --certify would keep "
      "it";
  CHECK(warning_of(s) == warning);
  CHECK(render(s, Format::text).find("warning          " + warning) != std::string::npos);
  CHECK(render(s, Format::json).find("\"warning\": \"" + warning) != std::string::npos);
  s.dropped_components.components = 3;
  CHECK(warning_of(s).find("--certify") == std::string::npos);
  s.dropped_components = {};
  s.certified_error = 0.1 + 1e-9;  // rounding of the output included
  CHECK(warning_of(s).find("is not kept everywhere") != std::string::npos);
  CHECK(warning_of(s).find("--certify") == std::string::npos);
  s.error.to_output.max = s.error.to_input.max = 0.1 + 1e-10;
  CHECK(warning_of(s).empty());
}

TEST_CASE("a run's summary counts no edges of the input that only its simplified parts have") {
  const auto summary_with = [](std::uint64_t border_edges) {
    RunSummary s;
    TopologyChange change;
    change.before.border_edges = border_edges;
    change.after.border_edges = border_edges;
    s.topology = change;
    return render(s, Format::json);
  };
  const auto count_of = [](const std::string& json, const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = json.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  const std::string closed = summary_with(0);
  CHECK(count_of(closed, "\"closed\": true") == 2);
  CHECK(count_of(closed, "\"border_edges\": 0") == 2);
  CHECK(count_of(closed, "\"nonmanifold_edges\": null") == 1);
  const std::string open = summary_with(8);
  CHECK(count_of(open, "\"closed\": false") == 2);
  CHECK(count_of(open, "\"border_edges\": 8") == 1);
  CHECK(count_of(open, "\"border_edges\": null") == 1);
}

TEST_CASE("an input's name may hold any bytes") {
  Manifest m;
  m.input = "caf\xe9.ply";  // Latin-1: no valid UTF-8
  CHECK_NOTHROW(render(m, "stage", Format::json));
}
