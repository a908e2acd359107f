// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/report/live_page.hpp>

#include "report/page_assets.hpp"

namespace meshfarm {

std::string render_live_page() {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<title>meshfarm</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n" +
         std::string(k_page_css) + std::string(k_live_css) + "</style>\n</head>\n<body>\n" +
         std::string(k_live_html) + "<script>\n" + std::string(k_live_js) +
         "</script>\n</body>\n</html>\n";
}

}  // namespace meshfarm
