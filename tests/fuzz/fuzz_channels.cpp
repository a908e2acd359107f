// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/channel_file.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  StagedChannels staged;
  staged.channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                     {"depth", ChannelType::uint16, ChannelRole::quality},
                     {"heat", ChannelType::float32, ChannelRole::quality}};
  staged.points = 100;
  fuzz::decode_staged(data, size, {'C', 'H', 'A', 'N'}, [&](std::string_view file) {
    ChannelReader reader(fill_from(file, "channels"), staged, PositionType::float32, "channels");
    ChannelPoints points;
    while (reader.next(points)) {
    }
  });
  return 0;
}
