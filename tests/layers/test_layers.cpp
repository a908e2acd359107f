// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

// Reads the layer table (the meshfarm_layer lines of CMakeLists.txt) and every #include, and
// reports file and line of everything that the table does not allow. The check works on texts, so
// that made-up ones can show that each rule fires.

namespace {

namespace fs = std::filesystem;

struct Package {
  std::string_view name;     // as in PACKAGES
  std::string_view pattern;  // a whole header, or a path prefix if it has a "/"
};

// The first match decides.
constexpr std::array k_packages{
    Package{"Boost::iostreams", "boost/iostreams/"},
    Package{"Boost::program_options", "boost/program_options"},
    Package{"Boost::headers", "boost/heap/"},
    Package{"Boost", "boost/"},
    Package{"METIS::METIS", "metis.h"},
    Package{"nanoflann::nanoflann", "nanoflann.hpp"},
    Package{"cppzmq", "zmq.hpp"},
    Package{"cppzmq", "zmq_addon.hpp"},
    Package{"cppzmq", "zmq.h"},
    Package{"PkgConfig::httplib", "httplib.h"},
    // The system's sockets, too, are only for the layer that uses ZeroMQ.
    Package{"cppzmq", "sys/socket.h"},
    Package{"cppzmq", "sys/un.h"},
    Package{"cppzmq", "sys/epoll.h"},
    Package{"cppzmq", "poll.h"},
    Package{"cppzmq", "netinet/"},
    Package{"cppzmq", "arpa/"},
    Package{"cppzmq", "net/"},
    Package{"cppzmq", "netdb.h"},
    Package{"cppzmq", "ifaddrs.h"},
    Package{"nlohmann_json::nlohmann_json", "nlohmann/"},
    Package{"meshoptimizer::meshoptimizer", "meshoptimizer.h"},
    Package{"PNG::PNG", "png.h"},
    Package{"$<TARGET_NAME_IF_EXISTS:draco::draco_static>", "draco/"},
    Package{"PkgConfig::turbojpeg", "turbojpeg.h"},
    Package{"PkgConfig::xxhash", "xxhash.h"},
    Package{"spdlog::spdlog", "spdlog/"},
    Package{"spdlog::spdlog", "fmt/"},
    Package{"doctest", "doctest/"},
};

// Packages that several layers may use: io reads JSON (glTF), and report writes it.
constexpr std::string_view k_of_many_layers = "nlohmann_json::nlohmann_json";

constexpr std::size_t k_max_lines = 600;

struct SourceFile {
  std::string path;  // relative to the project's root
  std::string text;
};

struct Layer {
  std::size_t line = 0;
  std::set<std::string> uses;
  std::set<std::string> packages;
};
using Layers = std::map<std::string, Layer>;
using Problems = std::vector<std::string>;

std::string at(const std::string& path, std::size_t line) {
  return path + ":" + std::to_string(line) + ": ";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The parts of a path between its "/".
std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  return parts;
}

Layer parse_layer(const std::string& arguments, std::size_t line, std::string& name) {
  Layer layer;
  layer.line = line;
  std::istringstream words(arguments);
  words >> name;
  std::set<std::string>* list = nullptr;
  for (std::string word; words >> word;) {
    if (word == "USES") {
      list = &layer.uses;
    } else if (word == "PACKAGES") {
      list = &layer.packages;
    } else if (list != nullptr) {
      list->insert(word);
    }
  }
  return layer;
}

Layers parse_layers(const std::string& cmake) {
  static const std::string k_call = "meshfarm_layer(";
  std::string text;  // without comments, but with their line ends, to keep the line numbers
  for (const std::string& line : lines_of(cmake)) text += line.substr(0, line.find('#')) + "\n";
  Layers layers;
  for (std::size_t begin = text.find(k_call); begin != std::string::npos;) {
    const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(begin), '\n');
    begin += k_call.size();
    const std::size_t end = std::min(text.find(')', begin), text.size());
    std::string name;
    Layer layer =
        parse_layer(text.substr(begin, end - begin), static_cast<std::size_t>(line), name);
    layers.emplace(name, std::move(layer));
    begin = text.find(k_call, end);
  }
  return layers;
}

/// Does `from` reach `to` through USES?
bool reaches(const Layers& layers, const std::string& from, const std::string& to,
             std::set<std::string>& seen) {
  if (!layers.contains(from) || !seen.insert(from).second) return false;
  const std::set<std::string>& uses = layers.at(from).uses;
  return uses.contains(to) || std::any_of(uses.begin(), uses.end(), [&](const std::string& next) {
           return reaches(layers, next, to, seen);
         });
}

void check_table(const Layers& layers, Problems& problems) {
  std::map<std::string, std::string> owners;
  for (const auto& [name, layer] : layers) {
    const std::string where = at("CMakeLists.txt", layer.line) + "layer " + name;
    for (const std::string& used : layer.uses) {
      if (!layers.contains(used)) problems.push_back(where + " uses unknown layer " + used);
    }
    std::set<std::string> seen;
    if (reaches(layers, name, name, seen)) problems.push_back(where + " uses itself in a cycle");
    for (const std::string& package : layer.packages) {
      const auto [owner, is_first] = owners.emplace(package, name);
      if (!is_first && package != k_of_many_layers) {
        problems.push_back(where + " names package " + package + " of layer " + owner->second);
      }
      if (std::none_of(k_packages.begin(), k_packages.end(),
                       [&](const Package& known) { return known.name == package; })) {
        problems.push_back(where + " names package " + package +
                           ", whose headers test_layers.cpp " +
                           "does not know: add them to its table");
      }
    }
  }
}

enum class Place { header, source, test };

struct Includer {
  Place place;
  std::string layer;
  const Layer& rules;
};

/// The package that a header belongs to; none for headers of the standard library and our own.
std::string package_of(const std::string& header) {
  for (const Package& package : k_packages) {
    const bool is_start = package.pattern.find('/') != std::string_view::npos;
    if (header == package.pattern || (is_start && header.starts_with(package.pattern))) {
      return std::string(package.name);
    }
  }
  return "";
}

/// What is wrong with this include; empty if nothing is.
std::string fault_of(const Includer& from, const std::string& header, bool is_quoted,
                     const Layers& layers) {
  const std::vector<std::string> parts = parts_of(header);
  if (std::find(parts.begin(), parts.end(), "..") != parts.end()) return "a path with ..";
  if (parts.front() == "meshfarm") {
    if (parts.size() < 3) return "a header of no layer";
    if (parts[1] == from.layer || from.rules.uses.contains(parts[1])) return "";
    return "layer " + from.layer + " does not use layer " + parts[1];
  }
  if (const std::string package = package_of(header); !package.empty()) {
    if (package == "doctest" && from.place == Place::test) return "";
    if (from.place == Place::header) return "a header of package " + package + " in include/";
    if (from.rules.packages.contains(package)) return "";
    return "layer " + from.layer + " does not name package " + package;
  }
  const bool has_folder = parts.size() > 1;
  if (!is_quoted && !(has_folder && layers.contains(parts.front()))) return "";
  if (from.place == Place::header) return "a private header in include/";
  if (has_folder && parts.front() == "support" && from.place == Place::test) return "";
  if (has_folder && parts.front() != from.layer) return "not a header of layer " + from.layer;
  return "";
}

struct Include {
  std::string header;
  bool is_quoted = false;
};

/// The include on a line; no header if there is none.
Include parse_include(const std::string& line) {
  std::string_view rest = line;
  const auto skip = [&rest](std::string_view word) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    const bool is_there = rest.starts_with(word);
    if (is_there) rest.remove_prefix(word.size());
    return is_there;
  };
  if (!skip("#") || !skip("include")) return {};
  const bool is_quoted = skip("\"");
  if (!is_quoted && !skip("<")) return {};
  return {std::string(rest.substr(0, rest.find(is_quoted ? '"' : '>'))), is_quoted};
}

void check_includes(const SourceFile& file, const Includer& from, const Layers& layers,
                    Problems& problems) {
  const std::vector<std::string> lines = lines_of(file.text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto [header, is_quoted] = parse_include(lines[i]);
    const std::string fault = header.empty() ? "" : fault_of(from, header, is_quoted, layers);
    if (!fault.empty()) problems.push_back(at(file.path, i + 1) + header + ": " + fault);
  }
}

void check_file(const SourceFile& file, const Layers& layers, Problems& problems) {
  const auto lines = static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
  if (lines > k_max_lines) {
    problems.push_back(at(file.path, lines) + "more than " + std::to_string(k_max_lines) +
                       " lines");
  }
  static const std::array<std::pair<std::string_view, Place>, 3> k_places{
      {{"include/meshfarm/", Place::header},
       {"src/", Place::source},
       {"tests/unit/", Place::test}}};
  for (const auto& [folder, place] : k_places) {
    if (!file.path.starts_with(folder)) continue;
    const std::vector<std::string> parts = parts_of(file.path.substr(folder.size()));
    if (parts.size() < 2 || !layers.contains(parts.front())) {
      problems.push_back(at(file.path, 1) +
                         "in no layer that CMakeLists.txt has a meshfarm_layer of");
      continue;
    }
    check_includes(file, {place, parts.front(), layers.at(parts.front())}, layers, problems);
  }
}

/// The name that a line defines at file scope, or "". Functions may be overloaded.
std::string name_at_file_scope(const std::string& line) {
  static const std::regex k_names(
      "(?:(?:inline |static )*constexpr [^(=;{]*?\\b(k_\\w+)\\s*(?:\\[.*\\])?\\s*[={;].*"
      "|(?:struct|class|enum class) (\\w+)\\b(?!:)[^;]*"
      "|using (\\w+) =.*)");
  std::smatch match;
  if (!std::regex_match(line, match, k_names)) return {};
  return match[1].matched ? match[1] : match[2].matched ? match[2] : match[3];
}

/// Which sources are compiled together depends on their number, so two sources that define the same
/// name may go unnoticed for long.
void check_names(const std::vector<SourceFile>& files, Problems& problems) {
  std::map<std::pair<std::string, std::string>, std::string> first;  // (layer, name) -> path
  for (const SourceFile& file : files) {
    if (!file.path.starts_with("src/") || !file.path.ends_with(".cpp")) continue;
    const std::vector<std::string> lines = lines_of(file.text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string name = name_at_file_scope(lines[i]);
      if (name.empty()) continue;
      const auto [at_name, is_new] = first.try_emplace({parts_of(file.path)[1], name}, file.path);
      if (is_new || at_name->second == file.path) continue;
      problems.push_back(at(file.path, i + 1) + name + " is defined in " + at_name->second +
                         " too");
    }
  }
}

Problems check_layers(const std::string& cmake, const std::vector<SourceFile>& files) {
  Problems problems;
  const Layers layers = parse_layers(cmake);
  check_table(layers, problems);
  for (const SourceFile& file : files) check_file(file, layers, problems);
  check_names(files, problems);
  return problems;
}

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  REQUIRE_MESSAGE(in.good(), path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<SourceFile> read_tree(const fs::path& root) {
  std::vector<SourceFile> files;
  for (const char* folder : {"include", "src", "tests", "bin"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path& path = entry.path();
      if (!entry.is_regular_file() || (path.extension() != ".cpp" && path.extension() != ".hpp")) {
        continue;
      }
      files.push_back({path.lexically_relative(root).generic_string(), read(path)});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

const std::string k_table =
    "# meshfarm_layer(none USES all)\n"
    "meshfarm_layer(low USES PACKAGES spdlog::spdlog)\n"
    "meshfarm_layer(mid  USES low\n"
    "               PACKAGES METIS::METIS)\n"
    "meshfarm_layer(side USES low PACKAGES Boost::iostreams cppzmq)\n";

/// The problems of one file that has this one line, under k_table.
Problems problems_of(const std::string& path, const std::string& line) {
  return check_layers(k_table, {{path, "#pragma once\n" + line + "\n"}});
}

void check_refused(const std::string& path, const std::string& line, const std::string& fault) {
  CAPTURE(path);
  CAPTURE(line);
  const Problems problems = problems_of(path, line);
  REQUIRE(problems.size() == 1);
  CHECK(problems.front().starts_with(path + ":2: "));
  CHECK_MESSAGE(problems.front().find(fault) != std::string::npos, problems.front());
}

void check_allowed(const std::string& path, const std::string& line) {
  CAPTURE(path);
  CAPTURE(line);
  CHECK(problems_of(path, line).empty());
}

}  // namespace

TEST_CASE("the project keeps its own layer table") {
  const fs::path root = MESHFARM_SOURCE_DIR;
  const std::string cmake = read(root / "CMakeLists.txt");
  const std::vector<SourceFile> files = read_tree(root);
  // A check that read nothing would pass, too.
  CHECK(parse_layers(cmake).size() >= 10);
  CHECK(std::count_if(files.begin(), files.end(), [](const SourceFile& file) {
          return file.path.starts_with("include/meshfarm/");
        }) >= 10);
  for (const std::string& problem : check_layers(cmake, files)) FAIL_CHECK(problem);
}

TEST_CASE("what thinks in the farm, and its simulation, come to no socket") {
  const Layers layers = parse_layers(read(fs::path(MESHFARM_SOURCE_DIR) / "CMakeLists.txt"));
  for (const std::string name : {"farm", "simulation"}) {
    CAPTURE(name);
    REQUIRE(layers.contains(name));
    CHECK(!layers.at(name).packages.contains("cppzmq"));
    for (const auto& [other, layer] : layers) {
      std::set<std::string> seen;
      if (layer.packages.contains("cppzmq")) CHECK(!reaches(layers, name, other, seen));
    }
    for (const char* header :
         {"<zmq.hpp>", "<zmq.h>", "<sys/socket.h>", "<netinet/in.h>", "<poll.h>",
          "<meshfarm/transport/worker.hpp>", "\"transport/sockets.hpp\""}) {
      CAPTURE(header);
      for (const std::string folder : {"src/", "include/meshfarm/", "tests/unit/"}) {
        Problems problems;
        check_file({folder + name + "/a.hpp", std::string("#include ") + header + "\n"}, layers,
                   problems);
        CHECK(problems.size() == 1);
      }
    }
  }
}

TEST_CASE("the table is read with its comments, line breaks and line numbers") {
  const Layers layers = parse_layers(k_table);
  REQUIRE(layers.size() == 3);
  CHECK(layers.at("low").uses.empty());
  CHECK(layers.at("mid").line == 3);
  CHECK(layers.at("mid").uses == std::set<std::string>{"low"});
  CHECK(layers.at("mid").packages == std::set<std::string>{"METIS::METIS"});
  CHECK(layers.at("side").packages == std::set<std::string>{"Boost::iostreams", "cppzmq"});
}

TEST_CASE("a layer includes itself, what it uses, its packages and the standard library") {
  for (const char* path : {"include/meshfarm/mid/a.hpp", "src/mid/a.cpp", "tests/unit/mid/a.cpp"}) {
    check_allowed(path, "#include <vector>");
    check_allowed(path, "#include <sys/stat.h>");
    check_allowed(path, "#include <meshfarm/mid/b.hpp>");
    check_allowed(path, "  #  include <meshfarm/low/b.hpp>  // why");
  }
  check_allowed("src/mid/a.cpp", "#include \"mid/private.hpp\"");
  check_allowed("src/mid/a.cpp", "#include <metis.h>");
  check_allowed("src/side/a.cpp", "#include <boost/iostreams/filtering_stream.hpp>");
  check_allowed("src/low/a.cpp", "#include <fmt/format.h>");
  check_allowed("tests/unit/mid/a.cpp", "#include \"mid/private.hpp\"");
  check_allowed("tests/unit/mid/a.cpp", "#include \"support/meshes.hpp\"");
  check_allowed("tests/unit/mid/a.cpp", "#include <doctest/doctest.h>");
  check_allowed("bin/main.cpp", "#include <meshfarm/side/b.hpp>");
}

TEST_CASE("a layer that is not used is refused") {
  const std::string fault = "does not use layer side";
  check_refused("include/meshfarm/mid/a.hpp", "#include <meshfarm/side/b.hpp>", fault);
  check_refused("src/mid/deep/a.cpp", "#include <meshfarm/side/b.hpp>", fault);
  check_refused("src/low/a.cpp", "# include \"meshfarm/side/b.hpp\"", fault);
  check_refused("tests/unit/mid/a.cpp", "#include <meshfarm/side/b.hpp>", fault);
  check_refused("src/low/a.cpp", "#include <meshfarm/nowhere/b.hpp>", "does not use layer nowhere");
  check_refused("src/low/a.cpp", "#include <meshfarm/b.hpp>", "of no layer");
}

TEST_CASE("no two sources of a layer define the same name") {
  const auto problems_with = [](const std::string& path, const std::string& line) {
    return check_layers(k_table, {{"src/mid/a.cpp",
                                   "constexpr int k_many = 3;\nconstexpr double k_of[2]{1, 2};\n"
                                   "struct Step {\n};\nclass Walk : public Step {\n};\n"
                                   "using Steps = int;\n"},
                                  {path, line + "\n"}});
  };
  for (const std::string line :
       {"constexpr std::size_t k_many{25};", "static constexpr std::array<int, 2> k_of{1, 2};",
        "struct Step {", "enum class Walk {", "using Steps = double;"}) {
    CAPTURE(line);
    const Problems problems = problems_with("src/mid/deep/b.cpp", line);
    REQUIRE(problems.size() == 1);
    CHECK(problems.front().starts_with("src/mid/deep/b.cpp:1: "));
    CHECK(problems.front().ends_with(" is defined in src/mid/a.cpp too"));
    CHECK(problems_with("src/low/b.cpp", line).empty());
    CHECK(problems_with("src/mid/b.cpp", "  " + line).empty());
  }
  CHECK(problems_with("src/mid/b.cpp", "constexpr int k_more = k_many;").empty());
  CHECK(problems_with("src/mid/b.cpp", "struct Step;").empty());
}

TEST_CASE("a private header of another layer is refused") {
  check_refused("src/mid/a.cpp", "#include \"low/private.hpp\"", "not a header of layer mid");
  check_refused("src/mid/a.cpp", "#include <low/private.hpp>", "not a header of layer mid");
  check_refused("src/mid/a.cpp", "#include \"../low/private.hpp\"", "..");
  check_refused("src/mid/a.cpp", "#include \"support/meshes.hpp\"", "not a header of layer mid");
  check_refused("tests/unit/mid/a.cpp", "#include \"low/private.hpp\"",
                "not a header of layer mid");
  check_refused("include/meshfarm/mid/a.hpp", "#include \"mid/private.hpp\"", "in include/");
  check_refused("include/meshfarm/mid/a.hpp", "#include \"private.hpp\"", "in include/");
}

TEST_CASE("a package is refused outside its layer, and in include/ everywhere") {
  check_refused("src/low/a.cpp", "#include <metis.h>", "does not name package METIS");
  check_refused("tests/unit/low/a.cpp", "#include <metis.h>", "does not name package METIS");
  check_refused("src/mid/a.cpp", "#include <doctest/doctest.h>", "package doctest");
  // A layer that may use one Boost library may not use all of Boost.
  check_refused("src/side/a.cpp", "#include <boost/program_options.hpp>", "program_options");
  check_refused("src/side/a.cpp", "#include <boost/crc.hpp>", "package Boost");
  for (const Package& package : k_packages) {
    const std::string line = "#include <" + std::string(package.pattern) + "x>";
    const std::string whole = "#include <" + std::string(package.pattern) + ">";
    const bool is_start = package.pattern.find('/') != std::string_view::npos;
    check_refused("include/meshfarm/side/a.hpp", is_start ? line : whole,
                  "package " + std::string(package.name) + " in include/");
  }
}

TEST_CASE("a table with a cycle, an unknown layer or package, or a shared package is refused") {
  const auto only_problem = [](const std::string& cmake) {
    const Problems problems = check_layers(cmake, {});
    REQUIRE(problems.size() == 1);
    return problems.front();
  };
  CHECK(only_problem("meshfarm_layer(a USES a)") ==
        "CMakeLists.txt:1: layer a uses itself in a cycle");
  CHECK(
      check_layers("meshfarm_layer(a USES b)\nmeshfarm_layer(b USES c)\nmeshfarm_layer(c USES a)\n"
                   "meshfarm_layer(d USES a)",
                   {})
          .size() == 3);
  CHECK(only_problem("\nmeshfarm_layer(a USES b)") ==
        "CMakeLists.txt:2: layer a uses unknown layer b");
  CHECK(only_problem("meshfarm_layer(a USES PACKAGES Qt6)").find("does not know") !=
        std::string::npos);
  CHECK(only_problem("meshfarm_layer(a PACKAGES cppzmq)\nmeshfarm_layer(b PACKAGES cppzmq)") ==
        "CMakeLists.txt:2: layer b names package cppzmq of layer a");
}

TEST_CASE("a file outside the table's layers is refused") {
  for (const char* path : {"src/new/a.cpp", "include/meshfarm/new/a.hpp", "include/meshfarm/a.hpp",
                           "tests/unit/new/test_a.cpp", "src/a.cpp"}) {
    const Problems problems = check_layers(k_table, {{path, "\n"}});
    REQUIRE(problems.size() == 1);
    CHECK(problems.front().starts_with(std::string(path) + ":1: in no layer"));
  }
  CHECK(check_layers(k_table, {{"tests/support/a.hpp", "#include <metis.h>\n"}}).empty());
}

TEST_CASE("a file of more than 600 lines is refused") {
  CHECK(check_layers(k_table, {{"src/low/a.cpp", std::string(600, '\n')}}).empty());
  const Problems problems = check_layers(k_table, {{"src/low/a.cpp", std::string(601, '\n')}});
  REQUIRE(problems.size() == 1);
  CHECK(problems.front() == "src/low/a.cpp:601: more than 600 lines");
}
