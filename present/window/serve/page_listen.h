// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/serve/page_server.h"

struct lws_context;
struct lws_protocols;

namespace kilolux {

/// A context of libwebsockets that listens, with limits for what strangers can send. `protocols`
/// and the options' files must outlive it; `user` is what lws_context_user() returns. Throws Error
/// with the reason.
lws_context* listen_for_pages(const ServerOptions& options, const lws_protocols* protocols,
                              void* user);

}  // namespace kilolux
