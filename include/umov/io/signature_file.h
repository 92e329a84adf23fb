#pragma once
// A signature in a file, mapped into memory: docs/howto/library.md has the form.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <umov/core/mapped_file.h>
#include <umov/core/result.h>
#include <umov/inverse/signature.h>
#include <vector>

namespace umov {

/// What a file of a signature says of itself, beside the light.
struct SignatureText {
  std::string name;                 ///< of the object in the library
  std::string job;                  ///< SHA-256 of all that the file was made from
  std::string shape;                ///< SHA-256 of what the abundances were made from
  std::vector<std::string> bands;   ///< names, in the order of the codes
  std::vector<std::string> columns; ///< of the abundances, in words; empty: none are kept
  double sun_radius_rad = 0;
  std::string device = {}; ///< who lit it, as LightModel::lit_by; empty: the processor
};

/// A signature with its text and its abundances: spans into the bytes of a file.
struct SignatureView {
  SignatureText text;
  Signature signature;
  std::span<const float> abundances; ///< [pair * columns + column]
};

/// Reads the bytes of a file, which must begin at a multiple of 8 and outlive the view. BadInput
/// for what is none, of another version or byte order, damaged or cut short. The sums of abundances
/// are checked too if `checks_all`.
Result<SignatureView> parse_signature(std::string_view bytes, const std::string &file,
                                      bool checks_all);

/// What a file has room for, asked before the light is made. Usage for more cells or bands.
Result<void> check_signature_size(std::size_t cells, std::size_t bands);

/// The bytes of a file. `abundances` has text.columns for every pair of `cells`, or is empty.
/// Physics for what parse_signature would not take.
Result<std::string> signature_bytes(const SignatureText &text, std::size_t cells,
                                    const PackedLight &light, double error,
                                    std::span<const float> abundances);

/// A file, mapped: nothing is read before it is looked at.
class SignatureFile {
public:
  /// BadInput as parse_signature, or where there is no such file.
  static Result<SignatureFile> open(const std::filesystem::path &path, bool checks_all = false);
  /// What it holds; valid as long as this is.
  [[nodiscard]] const SignatureView &view() const { return view_; }

private:
  SignatureFile() = default;
  MappedFile mapped_;
  SignatureView view_; ///< of its bytes
};

} // namespace umov
