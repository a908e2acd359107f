// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// A host that worked on a stage: control/ID.host. An NFSv4 server takes two hosts of the same name
/// for one client and mixes up their state, so such hosts must be detected.
struct HostCard {
  std::string host;
  std::uint64_t boot = 0;     // identifies this boot of this host
  std::int64_t booted_s = 0;  // since 1970
  std::int64_t seen_s = 0;    // when it last wrote this card
  friend bool operator==(const HostCard&, const HostCard&) = default;
};

std::string encode_host_card(const HostCard& card);
/// Throws DataError naming `what`.
HostCard decode_host_card(std::string_view file, std::string_view what);

/// The card of this host, now.
HostCard this_host();
/// Publishes the card in the stage. Throws IoError.
void publish_host_card(const Stage& stage, const HostCard& card);
/// The readable cards, by name and boot. Throws IoError if the folder cannot be listed.
std::vector<HostCard> read_host_cards(const Stage& stage);

/// Names that two hosts had at the same time, without duplicates.
std::vector<std::string> names_in_double_use(std::span<const HostCard> cards);

}  // namespace meshfarm
