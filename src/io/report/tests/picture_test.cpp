// Pictures in files: OpenEXR read back by its own library, animations by their chunks.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <umov/io/exr.h>
#include <umov/io/plot_page.h>
#include <umov/io/png.h>
#include <umov/picture/keyframe.h>

namespace umov {
namespace {

TEST(Exr, ChannelsComeBackAsTheyWere) {
  const PictureChannel i{"nm:550.I", {1.f, 2.5f, 3.f, 1e-20f, 5.f, 6.f}},
      q{"nm:550.Q", {-.1f, 0, .3f, 0, -5.f, 6.f}};
  const std::vector<PictureChannel> channels{i, q};
  const std::vector<std::pair<std::string, std::string>> notes{{"POLCCONV", "IAU"}};
  const auto bytes = encode_exr(3, 2, channels, notes);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto path = std::filesystem::path(testing::TempDir()) / "umov_picture_test.exr";
  std::ofstream(path, std::ios::binary) << *bytes;
  Imf::InputFile file(path.c_str());
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("POLCCONV").value(), "IAU");
  for (const PictureChannel &channel : channels) {
    std::vector<float> read(6);
    Imf::FrameBuffer buffer;
    buffer.insert(channel.name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(read.data()),
                                           sizeof(float), 3 * sizeof(float)));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 1);
    EXPECT_EQ(read, channel.values) << channel.name;
  }
  EXPECT_EQ(*encode_exr(3, 2, channels, notes), *bytes);
  EXPECT_FALSE(encode_exr(4, 2, channels, notes));
}

TEST(Animation, HasItsFramesInOrder) {
  const std::vector<std::vector<std::uint8_t>> frames{std::vector<std::uint8_t>(12, 10),
                                                      std::vector<std::uint8_t>(12, 200)};
  const auto bytes = encode_animation(2, 2, frames, 10);
  ASSERT_TRUE(bytes);
  const auto count = [&](const std::string &type) {
    std::size_t n = 0;
    for (std::size_t at = bytes->find(type); at != std::string::npos;
         at = bytes->find(type, at + 1))
      ++n;
    return n;
  };
  EXPECT_EQ(count("acTL"), 1u);
  EXPECT_EQ(count("fcTL"), 2u);
  EXPECT_GE(count("IDAT"), 1u);
  EXPECT_GE(count("fdAT"), 1u);
  EXPECT_LT(bytes->find("acTL"), bytes->find("IDAT")); // as the standard wants
  EXPECT_FALSE(encode_animation(3, 2, frames, 10));
}

TEST(KeyFrameStokes, AxesOfThePicture) {
  // One lit sample with q = 1 in a scattering frame whose +Q lies 30 deg from up over left: IAU
  // position angle 30 deg, so Q = cos 60, U = sin 60.
  KeyFrameRaster raster;
  raster.side = raster.samples = 1;
  raster.pa_scat_rad = 30 * pi / 180;
  KeyFrameSample sample;
  sample.material = 0;
  sample.radiance = 2;
  sample.q = 1;
  raster.points = {sample};
  const auto channels = stokes_channels(raster, "x.");
  ASSERT_EQ(channels.size(), 5u);
  EXPECT_EQ(channels[0].name, "x.I");
  EXPECT_NEAR(channels[0].values[0], 2, 1e-6);
  EXPECT_NEAR(channels[1].values[0], 2 * std::cos(pi / 3), 1e-6);
  EXPECT_NEAR(channels[2].values[0], 2 * std::sin(pi / 3), 1e-6);
  EXPECT_EQ(channels[4].values[0], 1);
}

TEST(KeyFrameStokes, PolarizerSplitsTheLight) {
  KeyFrameRaster raster;
  raster.side = raster.samples = 1;
  KeyFrameSample sample;
  sample.material = 0;
  sample.radiance = 1;
  sample.q = 0.6f;
  raster.points = {sample};
  KeyFrameRaster across = raster, along = raster;
  apply_polarizer(across, true);
  apply_polarizer(along, false);
  EXPECT_NEAR(across.points[0].radiance, 0.8, 1e-6); // Malus: (1 + q)/2
  EXPECT_NEAR(along.points[0].radiance, 0.2, 1e-6);
}

TEST(PlotSvg, IsWholeAndSkipsWhatIsNotANumber) {
  PlotFigure figure{"a < b", "x", "y", {{"line", {0, 1, 2, 3}, {1, std::nan(""), 3, 4}}}};
  const std::string svg = plot_svg(figure);
  EXPECT_TRUE(svg.starts_with("<svg"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  figure.lines[0].z = {1, 2, 3, 4};
  figure.z_title = "z";
  EXPECT_EQ(plot_svg(figure).find("nan"), std::string::npos);
  figure.lines.clear();
  EXPECT_EQ(plot_svg(figure).find("nan"), std::string::npos); // nothing to show is no error
}

} // namespace
} // namespace umov
