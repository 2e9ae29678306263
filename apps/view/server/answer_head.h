// answer_head.h — what stands at the head of every answer: its kind, and what a browser may do with it.
#pragma once

#include <boost/beast/http.hpp>

namespace glisson::view {

/// Type, no storing, no Referer, and a policy that lets a page load nothing and talk to this server only.
void put_head(boost::beast::http::response_header<>& head, const char* type);

}  // namespace glisson::view
