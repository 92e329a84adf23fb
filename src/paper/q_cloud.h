#pragma once
// Clouds of Q in three bands.

#include "paper/plane_fit.h"
#include "paper/workshop.h"

namespace umov {

/// The lit poses of a table: their Q, I at 550 nm, and which poses they are.
struct QCloud {
  std::vector<QPoint> q;
  std::vector<double> intensity;
  std::vector<std::size_t> pose;
};
QCloud q_cloud(const StokesTable &light);
/// The same from a light curve.
QCloud q_cloud(const LightCurve &curve);

/// In space: Q blue, green, red.
PlotLine space_line(const std::string &name, std::size_t colour, const QCloud &cloud,
                    bool has_markers = true);
PlotFigure q_space(const std::string &title);

/// Edge on: along the widest spread within the plane, and off the plane.
PlotLine edge_line(const std::string &name, std::size_t colour, const QCloud &cloud,
                   const PlaneFit &plane);

/// "(-.131, .769, -.626)".
std::string normal_text(const PlaneFit &plane);
/// Angle between the normals of two planes [deg].
double angle_between_deg(const PlaneFit &a, const PlaneFit &b);

/// All six materials of Table 1 in random shares: their Q at a phase angle.
std::vector<QPoint> random_mixtures(double phase_deg, std::size_t count);

} // namespace umov
