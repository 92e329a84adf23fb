#include <umov/io/sites.h>

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/text.h>

UMOV_EMBEDDED(sites)

namespace umov {
namespace {

std::vector<Site> known_sites() {
  std::vector<Site> out;
  std::string_view text = sites();
  for (bool is_header = true; !text.empty(); is_header = false) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto cells = csv_cells(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (is_header || !cells || cells->size() != 4)
      continue;
    const auto number = [&](std::size_t k) { return parse_number((*cells)[k].text).value(); };
    out.push_back(make_site((*cells)[0].text, number(1), number(2), number(3)).value());
  }
  return out;
}

/// Lower case, letters and digits alone.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

} // namespace

std::vector<std::string> site_names() {
  std::vector<std::string> out;
  for (const Site &site : known_sites())
    out.push_back(site.name);
  return out;
}

Result<Site> site_from(const std::string &text) {
  if (const auto cells = csv_cells(text); cells && (cells->size() == 3 || cells->size() == 2)) {
    const auto lat = parse_number((*cells)[0].text), lon = parse_number((*cells)[1].text);
    const auto alt = cells->size() == 3 ? parse_number((*cells)[2].text) : std::optional(0.0);
    if (lat && lon && alt) {
      auto site = make_site("", *lat, *lon, *alt);
      if (!site)
        return fail(
            site.error().code,
            fmt::format("site \"{}\": {}. It is latitude, longitude [deg] and altitude [m].", text,
                        site.error().message));
      return site;
    }
  }
  for (Site &site : known_sites())
    if (plain(site.name) == plain(text))
      return std::move(site);
  const auto names = site_names();
  const auto near = nearest_name(text, names);
  return fail(ErrorCode::Usage,
              fmt::format("site \"{}\" is not known.{} Names are {}; or give latitude, longitude "
                          "[deg, north and east positive] and altitude [m], separated by commas.",
                          text, near ? fmt::format(" Did you mean \"{}\"?", *near) : "",
                          fmt::join(names, ", ")));
}

} // namespace umov
