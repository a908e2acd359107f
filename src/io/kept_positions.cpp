// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "kept_positions.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "scratch_file.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_in_memory = std::uint64_t{2} << 20;  // 48 MB
constexpr std::size_t k_batch = 8192;

}  // namespace

KeptPositions::KeptPositions(PositionType type, std::uint64_t vertices) : type_(type) {
  if (vertices <= k_most_in_memory) return;
  ScratchFile scratch = make_scratch_file();
  folder_ = std::move(scratch.folder);
  file_ = std::move(scratch.fd);
}

void KeptPositions::add(std::span<const Vec3> batch) {
  if (file_) {
    write(batch);
  } else {
    memory_.insert(memory_.end(), batch.begin(), batch.end());
  }
  count_ += batch.size();
}

void KeptPositions::write(std::span<const Vec3> batch) {
  if (type_ == PositionType::float64) {
    write_all(file_.get(), {reinterpret_cast<const char*>(batch.data()), batch.size_bytes()},
              folder_);
    return;
  }
  floats_.clear();
  for (const Vec3& p : batch) {
    for (const double x : {p.x, p.y, p.z}) floats_.push_back(static_cast<float>(x));
  }
  write_all(file_.get(),
            {reinterpret_cast<const char*>(floats_.data()), floats_.size() * sizeof(float)},
            folder_);
}

void KeptPositions::read(std::uint64_t offset, std::span<char> out) const {
  if (read_at(file_.get(), offset, out, folder_) != out.size()) {
    throw IoError("cannot read a scratch file in", folder_, EIO);
  }
}

void KeptPositions::scan(const std::function<void(std::span<const Vec3>)>& take) const {
  std::vector<Vec3> batch;
  std::vector<float> floats;
  for (std::uint64_t done = 0; done < count_; done += batch.size()) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(count_ - done, k_batch));
    if (!file_) {
      batch.assign(memory_.begin() + static_cast<std::ptrdiff_t>(done),
                   memory_.begin() + static_cast<std::ptrdiff_t>(done + size));
    } else if (type_ == PositionType::float64) {
      batch.resize(size);
      read(done * sizeof(Vec3), {reinterpret_cast<char*>(batch.data()), size * sizeof(Vec3)});
    } else {
      floats.resize(3 * size);
      read(done * 3 * sizeof(float),
           {reinterpret_cast<char*>(floats.data()), floats.size() * sizeof(float)});
      batch.clear();
      for (std::size_t i = 0; i < floats.size(); i += 3) {
        batch.push_back({floats[i], floats[i + 1], floats[i + 2]});
      }
    }
    take(batch);
  }
}

}  // namespace meshfarm
