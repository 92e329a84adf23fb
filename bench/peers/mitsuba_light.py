"""Light of a mesh by Mitsuba 3, many poses in one kernel: what the comparison runs against.

Mitsuba's own `render` takes one Sun and one sensor. Here every lane has its own pose: a ray from the
observer's side through a window as tight as the body's outline, one shadow ray to the Sun, the polarized
BRDF between the two. Points in the window are an R2 lattice (Roberts 2018), shifted per pose.
`evaluate` has direct light only, as the engine's: a straight line, so that nothing is spent on paths.
`evaluate_paths` goes on from surface to surface, with a look at the Sun at each, in one kernel too.

Stokes are in m2/sr per unit irradiance (the field average of radiance times the window's area), Q > 0
across the scattering plane, as umov has them. Mitsuba's V has the opposite sign and is 0 here.
"""

import numpy as np


def mean_fresnel(n):
    """Of unpolarized light on a dielectric, over the hemisphere by the cosine."""
    x, w = np.polynomial.legendre.leggauss(200)
    cosine, w = (x + 1) / 2, w / 2
    inside = np.sqrt(1 - (1 - cosine**2) / n**2)
    s, p = (cosine - n * inside) / (cosine + n * inside), (n * cosine - inside) / (n * cosine + inside)
    return float(np.sum(w * cosine * (s**2 + p**2)))


class MitsubaScene:
    def __init__(self, mesh_groups, materials, wavelengths_nm):
        """mesh_groups: {name: (vertices, triangles)}; materials: {name: {"alpha", "n", "k"}} with n and k
        as a list over wavelengths_nm (one: a monochrome variant; up to four: one spectral lane each), or
        {"alpha", "n", "body"}: a polarized plastic of that index over a body of that reflectance."""
        import drjit
        import mitsuba

        self.is_mono = len(wavelengths_nm) == 1
        mitsuba.set_variant("llvm_ad_mono_polarized" if self.is_mono else "llvm_ad_spectral_polarized")
        self.mi, self.dr = mitsuba, drjit
        self.wavelengths = list(wavelengths_nm)
        points = np.vstack([v for v, _ in mesh_groups.values()])
        self.centre = (points.min(0) + points.max(0)) / 2
        self.radius = float(np.linalg.norm(points - self.centre, axis=1).max())
        self.outline = self._hull(points) - self.centre
        scene = {"type": "scene"}
        for name, (vertices, triangles) in mesh_groups.items():
            properties = mitsuba.Properties()
            properties["bsdf"] = mitsuba.load_dict(self._bsdf(materials[name]))
            properties["face_normals"] = True
            mesh = mitsuba.Mesh(name, len(vertices), len(triangles), props=properties)
            parameters = mitsuba.traverse(mesh)
            parameters["vertex_positions"] = mitsuba.Float(vertices.astype(np.float32).ravel())
            parameters["faces"] = mitsuba.UInt32(triangles.astype(np.uint32).ravel())
            parameters.update()
            scene["mesh_" + name] = mesh
        self.scene = mitsuba.load_dict(scene)

    @staticmethod
    def _hull(points):
        from scipy.spatial import ConvexHull

        return points[ConvexHull(points).vertices]

    def _spectrum(self, values):
        if self.is_mono:
            return float(values[0])
        return {"type": "irregular",
                "wavelengths": ", ".join(f"{w:g}" for w in self.wavelengths),
                "values": ", ".join(f"{v:.9g}" for v in values)}

    def _bsdf(self, material):
        if "body" in material:  # whose light is not thrown back from inside there: docs/theory/lobes.md, Eq. 8 has 1/(1 - Fbar)
            body = material["body"] / (1 - mean_fresnel(material["n"]))
            return {"type": "twosided", "bsdf": {"type": "pplastic", "distribution": "ggx", "alpha": material["alpha"],
                                                 "int_ior": material["n"], "diffuse_reflectance": self._spectrum([body])}}
        conductor = {"type": "roughconductor", "distribution": "ggx", "alpha": material["alpha"],
                     "eta": self._spectrum(material["n"]), "k": self._spectrum(material["k"])}
        return {"type": "twosided", "bsdf": conductor}

    def evaluate(self, sun, observer, samples, seed=0):
        """Stokes [pose, band, IQU] for unit vectors [pose, 3] in the body frame, direct light."""
        return self.evaluate_paths(sun, observer, samples, 1, seed)

    def evaluate_paths(self, sun, observer, samples, surfaces, seed=0):
        """The same of light that touches up to `surfaces` surfaces."""
        mi, dr = self.mi, self.dr
        across = np.cross(observer, sun)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        along = np.cross(observer, across)
        a, b = self.outline @ across.T, self.outline @ along.T
        low, high = np.c_[a.min(0), b.min(0)], np.c_[a.max(0), b.max(0)]
        half, middle = (high - low) / 2 * (1 + 1e-5), (high + low) / 2
        origin = (self.centre + middle[:, :1] * across + middle[:, 1:] * along
                  + 2 * self.radius * observer)

        count = len(sun)
        lane = dr.arange(mi.UInt32, count * samples)
        pose = lane // dr.opaque(mi.UInt32, samples)
        number = lane - pose * dr.opaque(mi.UInt32, samples)

        def of_pose(array, kind):
            flat = mi.Float(np.ascontiguousarray(array, np.float32).ravel())
            return dr.gather(kind, flat, pose)

        to_sun, to_observer = of_pose(sun, mi.Vector3f), of_pose(observer, mi.Vector3f)
        x, y = of_pose(across, mi.Vector3f), of_pose(along, mi.Vector3f)
        size = of_pose(half, mi.Point2f)
        shift = of_pose(np.random.default_rng(seed).random((count, 2)), mi.Point2f)
        # The lattice in whole numbers: single precision would lose it for large ones.
        u = mi.Float(number * mi.UInt32(3242174889)) * 2.0**-32 + shift.x
        v = mi.Float(number * mi.UInt32(2447445414)) * 2.0**-32 + shift.y
        u, v = u - dr.floor(u), v - dr.floor(v)
        start = (of_pose(origin, mi.Vector3f) + x * ((2 * u - 1) * size.x)
                 + y * ((2 * v - 1) * size.y))
        ray = mi.Ray3f(mi.Point3f(start), -to_observer)
        if not self.is_mono:
            waves = self.wavelengths + [self.wavelengths[-1]] * (4 - len(self.wavelengths))
            ray.wavelengths = type(ray.wavelengths)(*[mi.Float(w) for w in waves])

        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed, count * samples)
        on = mi.Bool(True)
        total, before = mi.Spectrum(0.0), None
        for surface in range(surfaces):
            at = self.scene.ray_intersect(ray, on)
            on &= at.is_valid()
            light = at.to_local(to_sun)
            bsdf = at.bsdf(ray)
            seen = on & (light.z * at.wi.z > 0)
            seen &= ~self.scene.ray_test(at.spawn_ray(to_sun), seen)
            mueller = at.to_world_mueller(bsdf.eval(mi.BSDFContext(), at, light, seen), -light, at.wi)
            if before is not None:
                mueller = before @ mueller
            total += dr.select(seen, mueller, mi.Spectrum(0.0))
            if surface + 1 < surfaces:
                drawn, weight = bsdf.sample(mi.BSDFContext(), at, sampler.next_1d(on), sampler.next_2d(on), on)
                on &= drawn.pdf > 0
                weight = at.to_world_mueller(weight, -drawn.wo, at.wi)
                before = weight if before is None else before @ weight
                wavelengths = ray.wavelengths
                ray = at.spawn_ray(at.to_world(drawn.wo))
                ray.wavelengths = wavelengths
        mueller = mi.mueller.rotate_stokes_basis(
            to_observer, mi.mueller.stokes_basis(to_observer), x) @ total
        sums = [dr.block_sum(mueller[row, 0][band], samples)
                for band in range(len(self.wavelengths)) for row in range(3)]
        dr.eval(sums)
        area = 4 * half[:, 0] * half[:, 1] / samples
        out = np.stack([np.asarray(s, float) * area for s in sums], 1)
        return out.reshape(count, len(self.wavelengths), 3)
