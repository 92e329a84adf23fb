"""Every table of tests/data/anchors: its columns, the formulas and the rows."""

from dataclasses import dataclass
from typing import Callable

import mpmath

import bodies
import heights
import interfaces
import microfacet
import observing_air
import observing_instrument
import observing_pass
import observing_reduction
import passbands
import surroundings
import two_materials


@dataclass
class Table:
    formulas: str
    columns: str
    rows: Callable


def single_rows():
    """Numbers that stand alone; quotes.py says where."""
    au, al = interfaces.TABLE_1["paper_au"], interfaces.TABLE_1["paper_al"]
    gold = microfacet.between_facets(10, au[1])
    cosine = microfacet.np.cos(30 * microfacet.DEGREE)
    once = microfacet.weight(10, "ashikhmin", 30 * microfacet.DEGREE, 30 * microfacet.DEGREE, 0)
    once *= float(interfaces.factors(mpmath.mpf(1), au[1])[0])
    between = gold(cosine, cosine)
    body = microfacet.polarized_body(1.5, 1, 1e-6, 80, 0)
    chord, bow = two_materials.departure("paper_au", "paper_al", 140)
    sphere = 2 / (3 * mpmath.pi) * mpmath.mpf(".2")
    disk = mpmath.radians(mpmath.mpf(".2665"))
    nu, nv = 20, 200
    a140, b140 = interfaces.factors(interfaces.incidence(140), al[1])
    yield "al_550_140_M00", "microfacet.md 2", (a140, 6)
    yield "al_550_140_M01", "microfacet.md 2", (b140, 6)
    yield "ashikhmin_shirley_mean_cosine", "lobes.md 1", (mpmath.sqrt(
        mpmath.mpf((nu + 1) * (nv + 1)) / ((nu + 2) * (nv + 2))), 6)
    yield "gold_once_30", "microfacet.md 5", (once, 6)
    yield "gold_between_30", "lobes.md 9", (between, 7)
    yield "gold_degree_30", "lobes.md 9", (once / (once + between), 6)
    yield "polarized_body_n1.5_80", "lobes.md 8", (body[1] / body[0], 6)
    yield "planck_10um_300K", "lobes.md 12", (interfaces.planck(10, 300), 6)
    yield "gold_aluminium_chord", "paper.md 3", (chord, 5)
    yield "gold_aluminium_bow", "paper.md 3", (bow, 5)
    yield "lambert_cylinder", "closed_forms.md 4", (bodies.lambert_cylinder(2, 1, 60, 120, 80), 6)
    yield "mirror_cylinder", "closed_forms.md 7", (
        bodies.mirror_cylinder(2, 1, 60, 120, 80, mpmath.mpf(".2665")), 3)
    yield "mirror_plate_gain", "closed_forms.md 6", (1 / (2 * mpmath.pi * (1 - mpmath.cos(disk))), 0)
    yield "mirror_ellipsoid", "closed_forms.md 1", (
        bodies.mirror_ellipsoid((1, 2, 3), (1, 0, 0), (0, mpmath.mpf(".6"), mpmath.mpf(".8"))), 6)
    yield "lambert_sphere_60", "closed_forms.md 2", (list(bodies.lambert_sphere_rows())[2][1][0], 6)
    yield "lambert_sphere_magnitude", "photometry.md 1", (surroundings.magnitude(sphere, 1e6), 4)
    yield "mirror_sphere_magnitude", "photometry.md 1", (
        surroundings.magnitude(mpmath.mpf(".9") / 4, 1e6), 4)


PHASES = ",".join(str(p) for p in bodies.PHASES)
TABLES = {
    "bands": Table("bands.md 2 to 5: sunlight (ASTM E490) through each curve of data/filters",
                   "name,stem,pivot_nm,effective_nm,spread_nm,mean_w_m2_nm,ab,st,ab_zero_1e9_photons_s_m2,vega",
                   passbands.band_rows),
    "band_metals": Table("bands.md 2 and microfacet.md 2: a mirror of metal through a band",
                         "metal,band,phase_deg,intensity,q", passbands.metal_rows),
    "mueller": Table("microfacet.md 2; Table 1 of the paper", "material,nm,n,k,phase_deg,m00,m01,m22,m23",
                     interfaces.mueller_rows),
    "principal_angle": Table("microfacet.md 2: M22 = 0", "material,nm,n,k,phase_deg",
                             interfaces.principal_rows),
    "table1": Table("microfacet.md 2 and 6: at normal incidence, and 2 int F mu dmu",
                    "material,nm,n,k,f0,f_mean", interfaces.table1_rows),
    "q_140": Table("microfacet.md 2: B/A at phase 140 deg", "material,nm,q", interfaces.q_140_rows),
    "q_peak": Table("microfacet.md 2: largest B/A, and where", "material,nm,q,phase_deg",
                    interfaces.q_peak_rows),
    "q_tables": Table("microfacet.md 2: B/A against phase angle; rows 'sphere': closed_forms.md 5 with the "
                      "body light of microfacet.md 6, a-Si, R_sub = .1, m = 200, ashikhmin",
                      "material,nm," + PHASES, bodies.q_table_rows),
    "films": Table("lobes.md 6 (coherent), 7 (thick layer, slab): powers", "case,theta_deg,s,p",
                   interfaces.film_rows),
    "emission": Table("lobes.md 12, smooth", "n,k,theta_deg,e,q", interfaces.emission_rows),
    "masking": Table("microfacet.md 4, Blinn-Phong", "m,theta_deg,p", microfacet.masking_rows),
    "other_masking": Table("lobes.md 2, 3", "model,alpha,theta_deg,p", microfacet.other_masking_rows),
    "weights": Table("microfacet.md 5: f_s/F", "m,shadowing,theta_l_deg,theta_v_deg,phi_deg,w",
                     microfacet.weight_rows),
    "furnace": Table("microfacet.md 5: int f_s (n.v) dw with F = 1", "m,shadowing,theta_deg,e",
                     microfacet.furnace_rows),
    "body": Table("microfacet.md 6: a-Si, 550 nm, m = 200, R_sub = .1", "theta_l_deg,theta_v_deg,f",
                  microfacet.body_rows),
    "polarized_body": Table("lobes.md 8: a-Si, 550 nm, R_sub = .1; |U|",
                            "theta_l_deg,theta_v_deg,phi_deg,i,q,abs_u", microfacet.polarized_body_rows),
    "exponents": Table("lobes.md 10, H = .8, reference 550 nm", "m,m_425,m_650", microfacet.exponent_rows),
    "rough_gold_colour": Table("lobes.md 10, microfacet.md 5: I(425)/I(650) of a plate, source at 60 deg",
                               "m,theta_v_deg,ratio", microfacet.colour_rows),
    "polished": Table("lobes.md 11: 50 nm, 60 deg", "nm,share", microfacet.polished_rows),
    "rough_sphere": Table("closed_forms.md 5, ashikhmin", "m,phase_deg,j", bodies.rough_sphere_rows),
    "sphere_stokes": Table("closed_forms.md 5: M00 and M10 at phase 90 deg, R = 1", "material,m,nm,i,q",
                           bodies.sphere_stokes_rows),
    "lambert_sphere": Table("closed_forms.md 2", "phase_deg,j", bodies.lambert_sphere_rows),
    "sphere_colour": Table("closed_forms.md 5, lobes.md 10: gold, m = 100", "phase_deg,ratio",
                           bodies.sphere_colour_rows),
    "gold_sphere": Table("closed_forms.md 5, lobes.md 9: Q/I at 425 nm and phase 90 deg",
                         "interreflection,m,q", bodies.gold_sphere_rows),
    "silicon_cube": Table("microfacet.md 5, 6: median over 200,000 attitudes; closed_forms.md 5",
                          "phase_deg,cube_median,sphere", bodies.silicon_cube_rows),
    "explicit": Table("no formula: rays over height fields, good to .004; beside it microfacet.md 5 with "
                      "lobes.md 2, ashikhmin", "slope,theta_deg,once,model", heights.explicit_rows),
    "earthshine": Table("earthshine.md 2, 3: A = .3", "radius_km,zenith_deg,facet,around",
                        surroundings.earthshine_rows),
    "eclipse": Table("time_and_frames.md 8: a = .2666 deg, place = (c - b)/a", "radius_km,place,sunlit",
                     surroundings.eclipse_rows),
    "airmass": Table("photometry.md 3", "zenith_deg,airmass", surroundings.airmass_rows),
    "departures": Table("paper.md 3", "one,other,phase_deg,ratio", two_materials.departure_rows),
    "half_gold": Table("paper.md 2: equal weights of gold and aluminium, phase 140 deg", "nm,q",
                       two_materials.half_rows),
    "planes": Table("paper.md 2: 50,000 random mixtures", "phase_deg,blue,green,red,thickness",
                    two_materials.plane_rows),
    "observing_air": Table("observing.md 2", "name,formula,value", observing_air.rows),
    "observing_instrument": Table("observing.md 3, 4", "name,formula,value", observing_instrument.rows),
    "observing_pass": Table("observing.md 4: HST over Maui", "utc,psi_altaz,psi_pole,eta,rate,half_rate", observing_pass.rows),
    "observing_reduction": Table("observing.md 5, 6, 7", "name,formula,value", observing_reduction.rows),
    "singles": Table("as each row says", "name,formula,value", single_rows),
}


def cell(value):
    """A key as it is; (number, digits after the point) rounded to them."""
    if not isinstance(value, tuple):
        return str(value)
    number, digits = value
    if isinstance(digits, str):
        return f"{float(number):.{digits}}"
    shown = f"{float(number):.{digits}f}"
    return shown.lstrip("-") if float(shown) == 0 else shown


def text_of(table):
    lines = [f"# docs/theory/ {table.formulas}. Made by tools/anchors (CC0).", table.columns]
    width = table.columns.count(",") + 1
    for row in table.rows():
        assert len(row) == width, row
        lines.append(",".join(cell(value) for value in row))
    return "\n".join(lines) + "\n"
