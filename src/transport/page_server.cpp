// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <system_error>
#include <utility>

#include <dlfcn.h>

#include <meshfarm/transport/page_server.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// The module's function. The module stays loaded until the process ends.
ListenFunction* load() {
  void* const module = ::dlopen(k_page_module, RTLD_NOW | RTLD_LOCAL);
  void* const function = module == nullptr ? nullptr : ::dlsym(module, k_page_function);
  if (function == nullptr) {
    const char* const reason = ::dlerror();
    throw Error(std::string("cannot serve pages: ") + (reason != nullptr ? reason : k_page_module) +
                "; install the program whole: the module lies in lib/meshfarm or beside it");
  }
  return reinterpret_cast<ListenFunction*>(function);
}

}  // namespace

PageServer::PageServer(std::uint16_t port, PageAnswer answer) {
  static ListenFunction* const listen = load();
  try {
    listener_.reset(listen(port, std::move(answer)));
  } catch (const std::system_error& error) {
    throw IoError("cannot listen on", "127.0.0.1:" + std::to_string(port), error.code().value());
  }
}

}  // namespace meshfarm
