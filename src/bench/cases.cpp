#include "bench/cases.h"

#include <fmt/format.h>
#include <map>
#include <umov/io/obj.h>
#include <umov/io/scenario.h>
#include <umov/shape/primitives.h>

namespace umov::bench {
namespace {

constexpr MaskQuality without_rays(MaskQuality quality) {
  quality.refine_above = 0;
  return quality;
}

/// A sheet of n x n squares of 3 x 2 m.
Mesh panel(std::size_t n) {
  Mesh mesh;
  mesh.groups = {"bus", "panels"};
  for (std::size_t i = 0; i <= n; ++i)
    for (std::size_t j = 0; j <= n; ++j)
      mesh.positions.push_back({3.0 * static_cast<double>(i) / static_cast<double>(n),
                                2.0 * static_cast<double>(j) / static_cast<double>(n), 0});
  const auto at = [n](std::size_t i, std::size_t j) {
    return static_cast<std::uint32_t>(i * (n + 1) + j);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (const auto &corner : {std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)},
                                 std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)}}) {
        Triangle t;
        t.vertex = corner;
        t.front = t.back = 1;
        mesh.triangles.push_back(t);
      }
  return mesh;
}

Result<Mesh> case_mesh(const BenchCase &of, Diagnostics &diagnostics) {
  if (of.mesh == "box-wing")
    return make_box_wing({of.facets, 0});
  if (of.mesh == "foil")
    return make_box_wing({of.facets, 0.01});
  if (of.mesh == "panel")
    return panel(of.facets);
  if (of.mesh == "hst")
    return make_hst();
  if (of.mesh == "agena")
    return make_agena();
  UMOV_ASSIGN(read, read_obj(of.mesh, {"m", "+Z"}, diagnostics));
  return read.mesh;
}

/// Of each group of the telescope.
Result<std::vector<Material>> telescope_materials(const Mesh &mesh) {
  const std::map<std::string, const char *> names{{"light_shield", "film_aluminized"},
                                                  {"baffle", "paint_black"},
                                                  {"forward_shell", "film_aluminized"},
                                                  {"equipment", "film_silvered"},
                                                  {"aft_shroud", "film_silvered"},
                                                  {"door", "film_aluminized"},
                                                  {"array_front", "cell_silicon"},
                                                  {"array_back", "mli_kapton"},
                                                  {"array_frame", "aluminium_anodized"},
                                                  {"antenna", "paint_white"},
                                                  {"handrail", "paint_white"}};
  std::vector<Material> out;
  for (const std::string &group : mesh.groups) {
    const auto named = names.find(group);
    UMOV_ASSIGN(material, read_material(named != names.end() ? named->second : "paint_white"));
    out.push_back(std::move(material));
  }
  return out;
}

/// Gold, silicon, aluminium and a smoother gold over the groups.
Result<std::vector<Material>> rough_metals(const Mesh &mesh) {
  const std::pair<const char *, double> of[] = {
      {"paper_au", 0.3}, {"paper_asi", 0.2}, {"paper_al", 0.25}, {"paper_au", 0.15}};
  std::vector<Material> out;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    const auto &[name, alpha] = of[g % 4];
    UMOV_ASSIGN(material, builtin_material(name));
    material.body.reset();
    material.distribution = {"ggx", {{"alpha", alpha}}, {}, {}, {}};
    material.shadowing = Shadowing::Separable;
    out.push_back(std::move(material));
  }
  return out;
}

} // namespace

std::vector<BenchCase> standard_cases() {
  std::vector<BenchCase> out;
  const auto add = [&](std::string name, auto &&change) {
    BenchCase one;
    one.name = std::move(name);
    change(one);
    out.push_back(std::move(one));
  };
  const auto open = [](BenchCase &c) {
    c.visibility = Visibility::None;
    c.has_errors = false;
  };
  for (const char *set : {"best", "avx2", "sse4", "baseline"})
    add(fmt::format("no visibility, {}", set), [&](BenchCase &c) {
      open(c);
      c.instruction_set = set;
    });
  add("no visibility, 2 threads", [&](BenchCase &c) {
    open(c);
    c.threads = 2;
  });
  add("no visibility, intensity alone", [&](BenchCase &c) {
    open(c);
    c.is_intensity_only = true;
  });
  for (const std::size_t n : {1u, 10u})
    add(fmt::format("flat panel, {} triangles", 2 * n * n), [&](BenchCase &c) {
      open(c);
      c.mesh = "panel";
      c.facets = n;
    });
  for (const std::size_t bands : {1u, 16u})
    for (const bool own : {false, true})
      if (bands > 1 || !own)
        add(fmt::format("no visibility, {}", bands == 1 ? "1 band"
                                             : own      ? "16 bands, own roughness"
                                                        : "16 bands"),
            [&](BenchCase &c) {
              open(c);
              c.bands = bands;
              c.has_own_roughness = own;
            });
  for (const char *set : {"best", "avx2", "sse4", "baseline"})
    add(fmt::format("fast masks, {}", set), [&](BenchCase &c) {
      c.masks = without_rays(fast_masks);
      c.instruction_set = set;
      c.has_errors = std::string(set) == "best";
    });
  add("fast masks, 2 threads", [&](BenchCase &c) {
    c.masks = without_rays(fast_masks);
    c.threads = 2;
    c.has_errors = false;
  });
  for (const auto &[bands, own] : {std::pair{1u, false}, {16u, false}, {16u, true}})
    add(fmt::format("fast masks, {} band{}{}", bands, bands == 1 ? "" : "s",
                    own ? ", own roughness" : ""),
        [&, bands = bands, own = own](BenchCase &c) {
          c.masks = without_rays(fast_masks);
          c.bands = bands;
          c.has_own_roughness = own;
          c.has_errors = false;
        });
  add("fast masks and rays", [](BenchCase &) {});
  add("default of signature", [](BenchCase &c) { c.is_default_path = c.is_for_many = true; });
  add("default of run", [](BenchCase &c) { c.is_default_path = true; });
  add("fine masks", [](BenchCase &c) { c.masks = without_rays(fine_masks); });
  add("fast masks, series", [](BenchCase &c) {
    c.masks = without_rays(fast_masks);
    c.is_series = true;
    c.has_errors = false;
  });
  add("one pose, fast masks", [](BenchCase &c) {
    c.masks = without_rays(fast_masks);
    c.is_single_pose = true;
    c.has_errors = false;
  });
  add("hst, fast masks and rays", [](BenchCase &c) { c.mesh = "hst"; });
  add("hst, default of signature",
      [](BenchCase &c) { c.mesh = "hst", c.is_default_path = c.is_for_many = true; });
  const auto add_telescope = [&](const char *name, bool is_default, bool is_for_many) {
    add(name, [&](BenchCase &c) {
      c.mesh = "hst";
      c.normals = NormalMode::Smooth;
      c.has_library_materials = true;
      c.masks = without_rays(fast_masks);
      c.is_default_path = is_default;
      c.is_for_many = is_for_many;
    });
  };
  add_telescope("hst of the library, fast masks", false, false);
  add_telescope("hst of the library, default of signature", true, true);
  add_telescope("hst of the library, default of run", true, false);
  const auto add_between = [&](const std::string &mesh, BetweenMethod between, std::size_t bands,
                               const std::string &set) {
    add(fmt::format("{} between five surfaces, {} band{}, {}{}", mesh, bands, bands == 1 ? "" : "s",
                    name_of(between), set == "best" ? "" : ", " + set),
        [&](BenchCase &c) {
          c.mesh = mesh;
          c.bands = bands;
          c.has_rough_metals = c.is_default_path = true;
          c.bounces = 5;
          c.between = between;
          c.instruction_set = set;
          c.has_errors = false;
        });
  };
  for (const char *mesh : {"box-wing", "hst"}) {
    add_between(mesh, BetweenMethod::Paths, 1, "best");
    for (const std::size_t bands : {1u, 3u})
      add_between(mesh, BetweenMethod::Chains, bands, "best");
    add_between(mesh, BetweenMethod::Chains, 1, "avx2");
  }
  add("agena, fast masks and rays", [](BenchCase &c) { c.mesh = "agena"; });
  add("crumpled, 1,000,000 triangles, clustered", [](BenchCase &c) {
    c.mesh = "foil";
    c.facets = 1'000'000;
    c.cluster_rad = 0.01;
    c.masks = {60'000, 48, 48, 0};
  });
  return out;
}

std::vector<BenchCase> cases_for_mesh(const std::string &file) {
  std::vector<BenchCase> out;
  for (const auto &[name, quality] : {std::pair{"fast masks", without_rays(fast_masks)},
                                      std::pair{"fast masks and rays", fast_masks},
                                      std::pair{"fine masks and rays", fine_masks}}) {
    BenchCase one;
    one.name = name;
    one.mesh = file;
    one.masks = quality;
    out.push_back(one);
  }
  for (const bool is_for_many : {true, false}) { // what verbs take that are told nothing
    BenchCase one;
    one.name = is_for_many ? "default of signature" : "default of run";
    one.mesh = file;
    one.is_default_path = true;
    one.is_for_many = is_for_many;
    out.push_back(one);
  }
  return out;
}

Result<Scene> case_scene(const BenchCase &of, Diagnostics &diagnostics) {
  UMOV_ASSIGN(mesh, case_mesh(of, diagnostics));
  std::vector<Band> bands;
  for (std::size_t b = 0; b < of.bands; ++b) { // within Table 1 of the paper
    const double nm = of.bands == 1
                          ? 550
                          : 425 + 225 * static_cast<double>(b) / static_cast<double>(of.bands - 1);
    bands.push_back({fmt::format("nm:{:g}", nm), Wavelength::nm(nm)});
  }
  if (of.has_library_materials) {
    UMOV_ASSIGN(materials, telescope_materials(mesh));
    return make_scene(mesh, of.normals, bands, materials, materials, diagnostics);
  }
  if (of.has_rough_metals) {
    UMOV_ASSIGN(metals, rough_metals(mesh));
    return make_scene(mesh, of.normals, bands, metals, metals, diagnostics);
  }
  const char *names[] = {"paper_au", "paper_asi", "paper_spectralon", "paper_al"};
  const double exponents[] = {200, 1000, 20, 50};
  std::vector<Material> materials;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    UMOV_ASSIGN(material, builtin_material(names[g % 4]));
    material.distribution = blinn_phong(exponents[g % 4]);
    if (of.has_own_roughness)
      material.apparent_roughness = ApparentRoughness{0.8, 550, {}};
    materials.push_back(std::move(material));
  }
  return make_scene(mesh, of.normals, bands, materials, materials, diagnostics);
}

} // namespace umov::bench
