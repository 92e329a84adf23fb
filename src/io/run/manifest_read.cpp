#include "io/run/manifest_read.h"

#include <nlohmann/json.hpp>

namespace umov {

std::optional<OldManifest> read_manifest(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("program") || json["program"] != "umov")
    return std::nullopt;
  OldManifest out{"complete", {}, {}};
  if (const auto started = json.find("started_utc"); started != json.end() && started->is_string())
    out.started_utc = started->get<std::string>();
  if (const auto status = json.find("status"); status != json.end() && status->is_string())
    out.status = status->get<std::string>();
  if (const auto files = json.find("files"); files != json.end() && files->is_array())
    for (const auto &name : *files)
      if (name.is_string())
        out.files.push_back(name.get<std::string>());
  return out;
}

} // namespace umov
