// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A key file is sealed (staging/sealed.hpp), kind "KEYS", version 1:
//   server public text | server secret text | client public text | client secret text
//   text = length u32 = 40 | Z85
#include "transport/run_keys.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zmq.hpp>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "transport/sockets.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'K', 'E', 'Y', 'S'};
constexpr std::uint32_t k_version = 1;
constexpr std::size_t k_key_characters = 40;
constexpr std::uint64_t k_max_file_bytes = 4096;
constexpr int k_read_attempts = 6;

using KeyText = std::array<char, k_key_characters + 1>;

bool is_pair(const std::string& public_key, const std::string& secret_key) {
  KeyText derived{};
  return ::zmq_curve_public(derived.data(), secret_key.c_str()) == 0 &&
         public_key == derived.data();
}

std::filesystem::path key_path(const Stage& stage, std::uint64_t run,
                               const SecurityOptions& security) {
  return security.key_file.empty() ? stage.path(KeysName{run}) : security.key_file;
}

/// Lists the folder, which makes an NFS client ask the server whether the file exists.
bool is_listed(const std::filesystem::path& path) {
  const std::filesystem::path parent = path.parent_path();
  const std::filesystem::path folder = parent.empty() ? std::filesystem::path(".") : parent;
  std::error_code error;
  bool found = false;
  for (auto entry = std::filesystem::directory_iterator(folder, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    found = found || entry->path().filename() == path.filename();
  }
  if (error) throw IoError("cannot list", folder, error.value());
  return found;
}

RunKeys read_keys(const std::filesystem::path& path) {
  const Fd fd = open_for_read(path);
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) throw_errno("cannot look at", path);
  if (!S_ISREG(status.st_mode)) throw DataError(path.string() + ": not a file");
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw DataError(path.string() +
                    ": others may read these keys; run 'chmod 600' on it, or if the file system "
                    "keeps no such permissions, name a file on one that does with --key-file");
  }
  if (static_cast<std::uint64_t>(status.st_size) > k_max_file_bytes) {
    throw DataError(path.string() + ": too long for a key file");
  }
  return decode_keys(read_file(fd.get(), path), path.string());
}

/// The file existed before we were told of it, but an NFS client's cache may say otherwise.
RunKeys read_keys_patiently(const std::filesystem::path& path) {
  std::chrono::milliseconds wait(20);
  for (int attempt = 1;; ++attempt, wait *= 2) {
    try {
      return read_keys(path);
    } catch (const IoError& error) {
      const int number = error.error_number();
      if (attempt == k_read_attempts || (number != ENOENT && number != ESTALE)) throw;
    }
    std::this_thread::sleep_for(wait);
    is_listed(path);
  }
}

}  // namespace

RunKeys make_run_keys() {
  std::array<KeyText, 4> texts{};
  for (std::size_t i = 0; i < texts.size(); i += 2) {
    if (::zmq_curve_keypair(texts[i].data(), texts[i + 1].data()) != 0) {
      throw Error("this libzmq cannot encrypt (" + std::string(::zmq_strerror(errno)) +
                  "); --insecure does without");
    }
  }
  return {texts[0].data(), texts[1].data(), texts[2].data(), texts[3].data()};
}

std::string encode_keys(const RunKeys& keys) {
  ByteWriter out;
  out.put_string(keys.server_public);
  out.put_string(keys.server_secret);
  out.put_string(keys.client_public);
  out.put_string(keys.client_secret);
  return seal(k_kind, k_version, out.bytes());
}

RunKeys decode_keys(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  RunKeys keys;
  for (std::string* text :
       {&keys.server_public, &keys.server_secret, &keys.client_public, &keys.client_secret}) {
    *text = in.get_string();
    if (text->size() != k_key_characters) in.fail("a key of another length");
  }
  in.expect_end();
  if (!is_pair(keys.server_public, keys.server_secret) ||
      !is_pair(keys.client_public, keys.client_secret)) {
    in.fail("a secret key that does not belong to its public one");
  }
  return keys;
}

Keys keys_to_serve(const Stage& stage, std::uint64_t run, const SecurityOptions& security) {
  if (security.authentication == Authentication::none) return std::nullopt;
  const std::filesystem::path path = key_path(stage, run, security);
  if (!is_listed(path)) {
    AtomicFile file(path, to_hex(random_id()), AtomicFile::Readers::owner);
    file.write(encode_keys(make_run_keys()));
    file.commit_new();  // whether ours or another process's won: the file says
  }
  return read_keys_patiently(path);
}

Keys keys_to_connect(const Stage& stage, const Endpoint& endpoint,
                     const SecurityOptions& security) {
  const std::string whose = "the ventilator at " + endpoint.address + " (host " + endpoint.host +
                            ", pid " + std::to_string(endpoint.pid) + ") ";
  if (security.authentication == Authentication::none) {
    if (!endpoint.server_key.empty()) {
      throw DataError(whose + "authenticates, so this process must be started without --insecure");
    }
    return std::nullopt;
  }
  if (endpoint.server_key.empty()) {
    throw DataError(whose + "authenticates nobody; only processes with --insecure join it");
  }
  const std::filesystem::path path = key_path(stage, endpoint.run, security);
  RunKeys keys = read_keys_patiently(path);
  if (keys.server_public != endpoint.server_key) {
    throw DataError(path.string() + ": not the keys of " + whose +
                    "; give the same --key-file to all processes of a run");
  }
  return keys;
}

}  // namespace meshfarm
