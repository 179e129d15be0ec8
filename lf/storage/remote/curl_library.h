// SPDX-License-Identifier: Apache-2.0
// The functions of libcurl that are called. Internal to this folder.
#pragma once

#include "lf/core/result.h"

#ifdef LF_CURL_LIBRARY_NAME
#define CURL_DISABLE_TYPECHECK
#include <curl/curl.h>
#undef curl_easy_setopt
#undef curl_easy_getinfo

#include "lf/core/loaded_library.h"

namespace lf {

struct CurlCalls {
  LoadedLibrary library;
  LF_LOADED(curl_global_init);
  LF_LOADED(curl_easy_init);
  LF_LOADED(curl_easy_cleanup);
  LF_LOADED(curl_easy_setopt);
  LF_LOADED(curl_easy_getinfo);
  LF_LOADED(curl_easy_perform);
  LF_LOADED(curl_easy_strerror);
  LF_LOADED(curl_slist_append);
  LF_LOADED(curl_slist_free_all);
};

// Loads libcurl at the first call, in whichever of its two builds is installed (OpenSSL or GnuTLS).
// kOutput: none is.
Result<const CurlCalls*> Curl();

}  // namespace lf
#endif
