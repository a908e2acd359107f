// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#include <meshfarm/pipeline/run_follower.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

void RunFollower::look(std::optional<Trace>& trace) {
  const std::vector<std::uint32_t> numbers = stage_.traces();
  if (numbers.empty()) return;
  try {
    if (reader_ && reader_->number == numbers.back()) return read(*reader_, *trace);
    Reader next{numbers.back(), TraceFeed(stage_.path(TraceName{numbers.back()}).string())};
    Trace begun;
    read(next, begun);
    if (next.feed.lines() == 0) return;  // the file exists, but not its first line yet
    reader_ = std::move(next);
    trace = std::move(begun);
  } catch (const Error&) {
    reader_.reset();
    throw;
  }
}

/// Opens the file each time: only then does an NFS client ask the server for changes.
void RunFollower::read(Reader& reader, Trace& trace) const {
  const std::filesystem::path path = stage_.path(TraceName{reader.number});
  const Fd file = open_for_read(path);
  std::string piece(std::size_t{256} << 10, '\0');
  for (;;) {
    const std::size_t got = read_at(file.get(), reader.offset, piece, path);
    reader.offset += got;
    reader.feed.add({piece.data(), got}, trace);
    if (got < piece.size()) return;
  }
}

}  // namespace meshfarm
