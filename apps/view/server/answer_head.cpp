// answer_head.cpp — see answer_head.h.
#include "view/server/answer_head.h"

namespace glisson::view {

namespace http = boost::beast::http;

void put_head(http::response_header<>& head, const char* type) {
  head.set(http::field::content_type, type);
  head.set(http::field::cache_control, "no-store");
  head.set(http::field::connection, "close");
  head.set("Referrer-Policy", "no-referrer");
  head.set("X-Content-Type-Options", "nosniff");
  head.set("Content-Security-Policy",
           "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; font-src data:; "
           "img-src data: blob:; connect-src 'self' ws:; base-uri 'none'; form-action 'none'; "
           "frame-ancestors 'none'");
}

}  // namespace glisson::view
