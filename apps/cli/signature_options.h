#pragma once
// What the command line says of a signature: the light of which source, for which directions.

#include "part_options.h"

#include <umov/jobs/signature.h>

namespace umov::cli {

/// Options of `umov signature`.
struct SignatureOptions {
  std::string scene, geometry, output, visibility, source = "sun";
  std::string masks; ///< file to keep them in
  std::vector<std::string> overrides;
  std::vector<double> phases_deg, state{1, 0, 0, 0};
  std::vector<std::string> temperatures; ///< K, or group=K
  std::size_t poses = 0;
  std::uint64_t seed = 0;
  bool has_seed = false;
  double accuracy = 0;
  PartOptions part;
  CLI::Option *geometry_option = nullptr, *poses_option = nullptr, *seed_option = nullptr;
};

void add_signature_options(CLI::App &verb, SignatureOptions &o, Common &common);
/// What CLI11 cannot say; to be asked once all is parsed.
Result<void> check_directions(SignatureOptions &o);

jobs::SignatureRequest request_of(const SignatureOptions &o);
Result<jobs::PoseList> poses_of(const SignatureOptions &o, const Scenario &scenario);

} // namespace umov::cli
