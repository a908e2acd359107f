// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A host card is sealed (staging/sealed.hpp), kind "HOST", version 1:
//   host text | boot u64 | booted i64 | seen i64        text = length u32 | bytes
#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'H', 'O', 'S', 'T'};
constexpr std::uint32_t k_card_version = 1;
constexpr std::size_t k_max_host_bytes = 256;
/// Tolerance for clock differences between hosts; a reboot takes longer than this.
constexpr std::int64_t k_clock_tolerance_s = 5;

std::string boot_text() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::string encode_host_card(const HostCard& card) {
  ByteWriter out;
  out.put_string(card.host);
  out.put(card.boot);
  out.put(card.booted_s);
  out.put(card.seen_s);
  return seal(k_kind, k_card_version, out.bytes());
}

HostCard decode_host_card(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_card_version, what), what);
  HostCard card;
  card.host = in.get_string();
  if (card.host.size() > k_max_host_bytes) in.fail("a name too long");
  card.boot = in.get<std::uint64_t>();
  card.booted_s = in.get<std::int64_t>();
  card.seen_s = in.get<std::int64_t>();
  in.expect_end();
  return card;
}

HostCard this_host() {
  HostCard card;
  std::array<char, k_max_host_bytes> name{};
  if (::gethostname(name.data(), name.size() - 1) == 0) card.host = name.data();
  // Includes the name: containers of one host (and boot) may each have their own.
  card.boot = checksum(boot_text() + card.host);
  card.seen_s = static_cast<std::int64_t>(std::time(nullptr));
  timespec up{};
  ::clock_gettime(CLOCK_BOOTTIME, &up);
  card.booted_s = card.seen_s - static_cast<std::int64_t>(up.tv_sec);
  return card;
}

void publish_host_card(const Stage& stage, const HostCard& card) {
  // Replaces an older card of this host; a reader that reads it at this moment just skips it.
  stage.publish(HostName{card.boot}, encode_host_card(card), std::to_string(::getpid()));
}

std::vector<HostCard> read_host_cards(const Stage& stage) {
  std::vector<HostCard> cards;
  for (const std::uint64_t boot : stage.hosts()) {
    const HostName name{boot};
    try {
      cards.push_back(decode_host_card(stage.read(name), to_string(name)));
    } catch (const Error& error) {
      log_debug("left out: " + std::string(error.what()));
    }
  }
  std::sort(cards.begin(), cards.end(), [](const HostCard& a, const HostCard& b) {
    return a.host != b.host ? a.host < b.host : a.boot < b.boot;
  });
  return cards;
}

std::vector<std::string> names_in_double_use(std::span<const HostCard> cards) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < cards.size(); ++i) {
    for (std::size_t k = i + 1; k < cards.size(); ++k) {
      const HostCard& a = cards[i];
      const HostCard& b = cards[k];
      if (a.host != b.host || a.boot == b.boot) continue;
      // The same host before and after a reboot: the later boot is after the earlier card's last
      // time.
      const bool at_once = a.booted_s + k_clock_tolerance_s < b.seen_s &&
                           b.booted_s + k_clock_tolerance_s < a.seen_s;
      if (at_once && (names.empty() || names.back() != a.host)) names.push_back(a.host);
    }
  }
  return names;
}

}  // namespace meshfarm
