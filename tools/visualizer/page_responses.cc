// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_responses.h"

#include <utility>

namespace lf {
namespace {

struct HeldBody {
  std::string text;
  ByteBudget& budget;
};

void Free(void* held) {
  const std::unique_ptr<HeldBody> body(static_cast<HeldBody*>(held));
  body->budget.Return(body->text.size());
}

}  // namespace

void AddHeaders(MHD_Response* response, const char* type) {
  MHD_add_response_header(response, "Content-Type", type);
  MHD_add_response_header(response, "Cache-Control", "no-store");
  MHD_add_response_header(response, "Referrer-Policy", "no-referrer");
  MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
  MHD_add_response_header(response, "Content-Security-Policy",
                          "default-src 'self'; img-src 'self' blob: data:; style-src 'self' "
                          "'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'");
}

Response ResponseOf(PageAnswer& answer, ByteBudget& budget) {
  if (!budget.Take(answer.body.size())) {
    answer = Refusal(503, "unread answers fill the memory: try again");
    if (!budget.Take(answer.body.size())) return nullptr;
  }
  auto body = std::make_unique<HeldBody>(HeldBody{std::move(answer.body), budget});
  Response response(MHD_create_response_from_buffer_with_free_callback_cls(
      body->text.size(), body->text.data(), Free, body.get()));
  if (!response) {
    budget.Return(body->text.size());
    return nullptr;
  }
  [[maybe_unused]] HeldBody* const kept = body.release();  // Free() deletes it
  AddHeaders(response.get(), answer.type.c_str());
  if (answer.status == MHD_HTTP_METHOD_NOT_ALLOWED)
    MHD_add_response_header(response.get(), "Allow", "GET, HEAD, POST");
  return response;
}

Response ResponseOf(const PageFile& file) {
  Response response(MHD_create_response_from_buffer(
      file.bytes.size(), const_cast<char*>(file.bytes.data()), MHD_RESPMEM_PERSISTENT));
  if (response) AddHeaders(response.get(), file.type);
  return response;
}

}  // namespace lf
