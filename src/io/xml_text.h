#pragma once
// Private: documents as texts. pugixml leaves out a node that it has no memory for, and a stream
// what it cannot keep, both without a word: here both throw.

#include <cstddef>
#include <cstdlib>
#include <new>
#include <pugixml.hpp>
#include <string>
#include <utility>

namespace umov {

/// From here on a document that cannot grow throws; to be called before one is made.
inline void throw_where_memory_ends() {
  [[maybe_unused]] static const bool is_set = [] {
    pugi::set_memory_management_functions(
        [](std::size_t size) {
          void *const out = std::malloc(size);
          if (out == nullptr)
            throw std::bad_alloc();
          return out;
        },
        std::free);
    return true;
  }();
}

inline std::string text_of(const pugi::xml_document &document) {
  struct Writer final : pugi::xml_writer {
    std::string text;
    void write(const void *data, std::size_t size) override {
      text.append(static_cast<const char *>(data), size);
    }
  } out;
  document.save(out, "  ");
  return std::move(out.text);
}

} // namespace umov
