"""Which unit a plain number has, of every argument and of every key of a scenario: a Quantity is brought to it. A name alone does
not tell: `change_per_s` is in 1/s, and `sd_p` a part. What is not here has no unit that astropy knows."""
from __future__ import annotations

#: A part, a ratio, a probability, a Stokes parameter: percent goes into it.
PART = ""
_MAG, _SKY = "mag", "mag / arcsec2"

#: Arguments of Python that are floats. python/tests/test_units.py walks all signatures for one that is missing.
ARGUMENTS: dict[str, str] = {
    "accuracy": PART, "alt_deg": "deg", "alt_m": "m", "alt_min_deg": "deg", "angle_sd_deg": "deg", "aperture_fwhm": PART,
    "aperture_sd": PART, "attitude_sd_deg": "deg", "azimuth_deg": "deg", "change_per_s": "1 / s", "colour": _MAG, "crosstalk_sd": PART,
    "efficiency_sd": PART, "exposure_s": "s", "false_alarm": PART, "floor": PART, "gain_sd": PART, "gap_s": "s", "haze_sd": PART,
    "height_m": "m", "knot_s": "s", "largest_floor": PART, "laser": PART, "lat_deg": "deg", "lon_deg": "deg", "longest_s": "s", "mag": _MAG,
    "mag_max": _MAG, "none_prior": PART, "outliers": PART, "period_s": "s", "phase_deg": "deg", "phi_deg": "deg",
    "plate_sd_deg": "deg", "priors": PART, "q0_sd": PART, "rate_noise": "deg / s(3/2)", "rate_sd": "deg / s",
    "reflectance_sd": PART, "retardance_sd_deg": "deg", "scale_sd": PART, "sd_p": PART, "seeing_arcsec": "arcsec", "shortest_s": "s", "sky_mag": _SKY, "sky_p_sd": PART, "sky_sd": PART, "slope_sd": PART, "snr": PART,
    "step": "s", "step_s": "s", "sun_alt_max_deg": "deg", "temperatures": "K", "theta_i_deg": "deg", "theta_o_deg": "deg", "tilt_sd_deg": "deg", "time_sd_s": "s",
    "timeout_s": "s", "transparency_sd": PART, "transparency_time_s": "s", "wavelength_nm": "nm", "width_nm": "nm",
    "zero_point_sd": PART, "zero_sd_mag": _MAG}

#: Keys of a scenario that are numbers, or lists of them, as its schema has them; the same test compares both.
KEYS: dict[str, str] = {
    "accuracy": PART, "accuracy_floor": PART, "albedo": PART, "alpha": PART, "alt_m": "m", "alt_min_deg": "deg", "analyser_deg": "deg",
    "angle_deg": "deg", "angles_deg": "deg", "aperture_fwhm": PART, "aperture_m": "m", "arcsec": "arcsec", "at_nm": "nm", "bias_adu": "adu",
    "cadence_s": "s", "clock_error_s": "s", "crease_deg": "deg", "dark_e_s": "electron / s", "dead_time_s": "s", "dec_deg": "deg",
    "em_gain": PART, "exponent": PART, "exposure_s": "s", "extinction": PART, "focal_length_m": "m", "frame_px": "pix",
    "gain_e_adu": "electron / adu", "hurst": PART, "inertia": PART, "k": PART, "lat_deg": "deg", "line_time_s": "s", "lon_deg": "deg", "m": PART,
    "mag": _SKY, "moon": PART, "n": PART, "nonlinearity": PART, "nu": PART, "nv": PART, "obstruction": PART, "outer_scale_m": "m",
    "p": PART, "period_s": "s", "pitch_deg": "deg", "pivot_m": "m", "pixel_um": "um", "plate_deg": "deg", "plate_zero_deg": "deg",
    "position_km": "km", "pressure_hpa": "hPa", "q0": PART, "quaternion": PART, "ra_deg": "deg", "rate_deg_s": "deg / s", "read_e": "electron",
    "reference_nm": "nm", "reflectance": PART, "retardance_deg": "deg", "rms_deg": "deg", "rms_height_nm": "nm", "roll_deg": "deg",
    "sd_mag": _MAG, "share": PART, "size_px": "pix", "step_s": "s", "sun": PART, "sun_alt_max_deg": "deg", "tau_550": PART, "thickness_nm": "nm",
    "throughput": PART, "time_s": "s", "tracking_error_arcsec": "arcsec", "u0": PART, "velocity_km_s": "km / s", "water_cm": "cm",
    "wavelength_nm": "nm", "well_e": "electron", "width_nm": "nm", "x_axis_deg": "deg", "yaw_deg": "deg"}
