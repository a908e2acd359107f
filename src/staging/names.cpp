// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <charconv>

#include <meshfarm/staging/names.hpp>
#include <meshfarm/util/checksum.hpp>

namespace meshfarm {
namespace {

std::string six_digits(std::uint32_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return digits;
}

struct Printer {
  std::string operator()(ManifestName) const { return "manifest"; }
  std::string operator()(BoundaryName) const { return "boundary"; }
  std::string operator()(CutName) const { return "cut"; }
  std::string operator()(ChannelsName) const { return "channels"; }
  std::string operator()(PartName n) const { return "parts/" + six_digits(n.part) + ".part"; }
  std::string operator()(PictureName n) const {
    return "parts/" + six_digits(n.picture) + ".picture";
  }
  std::string operator()(StreamName n) const {
    return "streams/" + six_digits(n.stream) + ".stream";
  }
  std::string operator()(SlabName n) const { return "streams/" + six_digits(n.slab) + ".slab"; }
  std::string operator()(ResultName n) const {
    return "results/" + to_hex(n.key) + ".a" + std::to_string(n.attempt) + "." +
           to_hex(n.incarnation);
  }
  std::string operator()(JournalName n) const { return "journal/" + six_digits(n.number); }
  std::string operator()(EndpointName n) const {
    return "control/" + six_digits(n.epoch) + ".endpoint";
  }
  std::string operator()(TraceName n) const { return "log/" + six_digits(n.epoch) + ".trace"; }
  std::string operator()(SummaryName n) const { return "log/" + six_digits(n.number) + ".summary"; }
  std::string operator()(HostName n) const { return "control/" + to_hex(n.boot) + ".host"; }
  std::string operator()(KeysName n) const { return "control/" + to_hex(n.run) + ".keys"; }
};

/// Consumes text from the front. Lenient about the form of digits: parse_staged_name compares with
/// the printed name.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}
  bool word(std::string_view expected) {
    if (text_.substr(0, expected.size()) != expected) return false;
    text_.remove_prefix(expected.size());
    return true;
  }
  template <class T>
  bool number(T& value, int base) {
    const auto [end, error] =
        std::from_chars(text_.data(), text_.data() + text_.size(), value, base);
    if (error != std::errc{}) return false;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return true;
  }

 private:
  std::string_view text_;
};

std::optional<StagedName> scan(std::string_view text) {
  Scanner in(text);
  if (text == "manifest") return ManifestName{};
  if (text == "boundary") return BoundaryName{};
  if (text == "cut") return CutName{};
  if (text == "channels") return ChannelsName{};
  if (in.word("parts/")) {
    std::uint32_t number = 0;
    if (!in.number(number, 10)) return std::nullopt;
    if (in.word(".picture")) return PictureName{number};
    return PartName{number};
  } else if (in.word("streams/")) {
    std::uint32_t number = 0;
    if (!in.number(number, 10)) return std::nullopt;
    if (in.word(".slab")) return SlabName{number};
    return StreamName{number};
  } else if (in.word("results/")) {
    ResultName name;
    if (in.number(name.key, 16) && in.word(".a") && in.number(name.attempt, 10) && in.word(".") &&
        in.number(name.incarnation, 16)) {
      return name;
    }
  } else if (in.word("journal/")) {
    JournalName name;
    if (in.number(name.number, 10)) return name;
  } else if (in.word("log/")) {
    std::uint32_t number = 0;
    if (!in.number(number, 10)) return std::nullopt;
    if (in.word(".trace")) return TraceName{number};
    return SummaryName{number};
  } else if (in.word("control/")) {
    if (text.ends_with(".keys")) {
      KeysName name;
      if (in.number(name.run, 16)) return name;
    } else if (text.ends_with(".host")) {
      HostName name;
      if (in.number(name.boot, 16)) return name;
    } else {
      EndpointName name;
      if (in.number(name.epoch, 10)) return name;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string to_string(const StagedName& name) {
  return std::visit(Printer{}, name);
}

std::optional<StagedName> parse_staged_name(std::string_view text) {
  std::optional<StagedName> name = scan(text);
  if (name && to_string(*name) != text) return std::nullopt;
  return name;
}

}  // namespace meshfarm
