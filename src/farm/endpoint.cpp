// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// An endpoint file is sealed (staging/sealed.hpp), kind "ENDP", version 3:
//   epoch u32 | run u64 | address text | host text | pid u32 | server key text |
//   done u8
//   text = length u32 | bytes
// Version 1 had no server key, version 2 did not tell how a run had ended.
#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'E', 'N', 'D', 'P'};
constexpr std::uint32_t k_endpoint_version = 3;
constexpr std::size_t k_max_endpoint_bytes = 1024;

}  // namespace

std::string encode_endpoint(const Endpoint& endpoint) {
  ByteWriter out;
  out.put(endpoint.epoch);
  out.put(endpoint.run);
  out.put_string(endpoint.address);
  out.put_string(endpoint.host);
  out.put(endpoint.pid);
  out.put_string(endpoint.server_key);
  out.put(static_cast<std::uint8_t>(endpoint.done ? 1 : 0));
  return seal(k_kind, k_endpoint_version, out.bytes());
}

Endpoint decode_endpoint(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_endpoint_version, what), what);
  Endpoint endpoint;
  endpoint.epoch = in.get<std::uint32_t>();
  endpoint.run = in.get<std::uint64_t>();
  endpoint.address = in.get_string();
  endpoint.host = in.get_string();
  endpoint.pid = in.get<std::uint32_t>();
  endpoint.server_key = in.get_string();
  const auto done = in.get<std::uint8_t>();
  if (done > 1) in.fail("neither yes nor no");
  endpoint.done = done == 1;
  for (const std::string* text : {&endpoint.address, &endpoint.host, &endpoint.server_key}) {
    if (text->size() > k_max_endpoint_bytes) in.fail("a text too long");
  }
  in.expect_end();
  return endpoint;
}

Endpoint publish_endpoint(const Stage& stage, Endpoint endpoint, std::string_view unique) {
  for (;;) {
    const auto epochs = stage.epochs();
    endpoint.epoch = epochs.empty() ? 1 : epochs.back() + 1;
    const EndpointName name{endpoint.epoch};
    const std::string bytes = encode_endpoint(endpoint);
    if (!stage.publish_new(name, bytes, unique)) continue;
    // Without hard links two writers may both be told that they own it: the content decides.
    if (stage.read(name) == bytes) return endpoint;
  }
}

const std::vector<Endpoint>& EndpointList::look(const Stage& stage) {
  std::vector<Endpoint> found;
  auto known = known_.begin();
  for (const std::uint32_t epoch : stage.epochs()) {
    while (known != known_.end() && known->epoch < epoch) ++known;
    if (known != known_.end() && known->epoch == epoch) {
      found.push_back(*known);
      continue;
    }
    const EndpointName name{epoch};
    try {
      Endpoint endpoint = decode_endpoint(stage.read(name), to_string(name));
      if (endpoint.epoch == epoch) found.push_back(std::move(endpoint));
    } catch (const Error& error) {
      log_debug("left out: " + std::string(error.what()));
    }
  }
  known_ = std::move(found);
  return known_;
}

}  // namespace meshfarm
