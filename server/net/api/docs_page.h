#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "net/http/http_types.h"

namespace strata::net {

// A readable page of the contract, made from openapi.json on the server: no scripts, one style
// sheet of our own.
Result<Response> docs_page(const std::filesystem::path& openapi_json);
// Every `type` of a problem, with its status, its meaning and what to do.
std::string problems_html();
std::string docs_html(const nlohmann::json& contract);
std::string_view docs_style();
std::string html_escape(std::string_view text);

}  // namespace strata::net
