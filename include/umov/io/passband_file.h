#pragma once
// Curves of bands in files, and those that are compiled in.

#include <filesystem>
#include <optional>
#include <string>
#include <umov/core/result.h>
#include <umov/optics/band.h>
#include <vector>

namespace umov {

/// What is said of a curve beside its file; what the file says itself must agree.
struct PassbandForm {
  std::string unit; ///< of the wavelengths: nm, um or Angstrom; "": the file says
  std::optional<DetectorKind> detector;
  bool operator==(const PassbandForm &) const = default;
};

/// Reads the curve of a band from a text that stands for `file`: a VOTable of the SVO Filter
/// Profile Service (XML), or two columns of wavelength and response between blanks, commas or
/// semicolons (CSV, ECSV, plain), unit and detector in comments or names ("# unit: nm",
/// "# detector: photon"). The name is "file:" and that of the file. BadInput with file and line for
/// what is not a curve, and where unit or kind of detector are not said: neither is guessed.
Result<Passband> read_passband_text(const std::string &text, const std::string &file,
                                    const PassbandForm &form = {});

/// Names of the compiled-in curves ("Bessell.V"), in their groups.
std::vector<std::string> passband_names();
/// Names of a group ("Bessell": its U, B, V, R, I); empty if there is none of that name.
std::vector<std::string> passband_group(const std::string &name);
/// A compiled-in curve by name or by the stem of its file ("bessell-V"); BadInput with the nearest
/// name if there is none.
Result<Passband> find_passband(const std::string &name);

/// A band as a scenario names it, with what it says of a file.
struct BandEntry {
  std::string name; ///< "nm:550", "paper_rgb", "Bessell.V", "sdss" or "file:x.vot"
  PassbandForm form;
  bool operator==(const BandEntry &) const = default;
};

/// A file that was read, and its bytes.
struct BandFile {
  std::string path, bytes;
};

/// The bands that entries name, groups as all of their curves; what was read is added to `files`.
/// Paths of files are relative to `folder`.
Result<std::vector<Band>> read_bands(const std::vector<BandEntry> &entries,
                                     const std::filesystem::path &folder = {},
                                     std::vector<BandFile> *files = nullptr);
/// The same by names alone.
Result<std::vector<Band>> bands_named(const std::vector<std::string> &names);

} // namespace umov
