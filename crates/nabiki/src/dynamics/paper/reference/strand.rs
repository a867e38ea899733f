//! One strand, and the equations that move it, over any scalar.

use glam::{DMat3, Vec3};

use crate::dynamics::Dynamics;
use crate::dynamics::air::Air;
use crate::dynamics::gain::{SegmentShape, segment_shapes};
use crate::dynamics::paper::angles::{POLE_REST, POLE_SINE, azimuth, from_direction};
use crate::error::SettingError;
use crate::pseudo_force::Gamma;
use crate::region::FieldShares;
use crate::scalar::{Scalar, Vector};
use crate::skin::{SkinFrame, SkinPlace};

/// What is common to all strands.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Common {
    pub gamma: Gamma,
    /// From head space to the space of the angles, whose y is the polar axis.
    pub polar_from_head: DMat3,
}

/// A strand at some frame.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Strand<S> {
    segments: Vec<Segment<S>>,
    /// Root first (head space, cm).
    positions: Vec<Vector<S>>,
    /// The place of the skin that carries its root.
    on_skin: Option<SkinPlace>,
}

/// One segment s_i: its angles at frame n, and what moves it.
#[derive(Clone, Debug)]
struct Segment<S> {
    shape: SegmentShape,
    theta: S,
    phi: S,
    /// theta^n - theta^(n-1) (rad).
    theta_increment: S,
    /// phi^n - phi^(n-1) (rad).
    phi_increment: S,
}

impl<S: Scalar> Segment<S> {
    /// Equation (7) for theta and for phi. `gain`: c_i or eps_i c_i; `force`: F(n+1), in the space of the angles.
    #[inline(always)]
    fn advance(&mut self, gain: f64, force: Vector<S>) {
        let ((mut sin_theta, mut cos_theta), (mut sin_phi, mut cos_phi)) = (self.theta.sin_cos(), self.phi.sin_cos());
        let at_rest_on_the_pole = sin_theta.value().abs() < POLE_SINE && self.theta_increment.value().abs() < POLE_REST;
        if at_rest_on_the_pole && let Some(azimuth) = azimuth(force) {
            self.phi = azimuth;
            (sin_theta, cos_theta) = self.theta.sin_cos();
            (sin_phi, cos_phi) = self.phi.sin_cos();
        }
        let v_theta = Vector::new(cos_theta * sin_phi, -sin_theta, cos_theta * cos_phi);
        // v_i V_phi over u_i: the lever |s*| / 2 = d sin(theta) / 2, so that gain needs no second form.
        let v_phi = Vector::new(cos_phi, S::from(0.0), -sin_phi) * sin_theta;
        self.theta_increment += force.dot(v_theta).times(gain);
        self.phi_increment += force.dot(v_phi).times(gain);
        self.theta += self.theta_increment;
        self.phi += self.phi_increment;
    }

    /// (sin theta sin phi, cos theta, sin theta cos phi), as long as the segment.
    #[inline(always)]
    fn vector(&self) -> Vector<S> {
        let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (self.theta.sin_cos(), self.phi.sin_cos());
        Vector::new(sin_theta * sin_phi, cos_theta, sin_theta * cos_phi).times(self.shape.length)
    }
}

impl<S: Scalar> Strand<S> {
    /// Strand number `s` at rest.
    ///
    /// # Errors
    /// As [`segment_shapes`].
    pub fn new(dynamics: &Dynamics, common: &Common, strand: &[Vec3], s: usize) -> Result<Self, SettingError> {
        let segments = segment_shapes(dynamics, strand, s, 0)?.into_iter().zip(strand.windows(2)).map(|(shape, w)| {
            let (theta, phi) = from_direction(common.polar_from_head * (w[1].as_dvec3() - w[0].as_dvec3()));
            let (theta_increment, phi_increment) = (S::from(0.0), S::from(0.0));
            Segment { shape, theta: S::from(theta), phi: S::from(phi), theta_increment, phi_increment }
        });
        let positions = strand.iter().map(|p| p.as_dvec3().into()).collect();
        let on_skin = dynamics.skin.as_ref().map(|skin| skin.place(strand[0]));
        let mut strand = Self { segments: segments.collect(), positions, on_skin };
        strand.ride(dynamics.skin.as_ref().map(|skin| skin.at(0)));
        strand.place(common);
        Ok(strand)
    }

    /// A strand in the state of another, with constants for all numbers.
    pub fn of_known(known: &Strand<f64>) -> Self {
        let segment = |segment: &Segment<f64>| Segment {
            shape: segment.shape,
            theta: S::from(segment.theta),
            phi: S::from(segment.phi),
            theta_increment: S::from(segment.theta_increment),
            phi_increment: S::from(segment.phi_increment),
        };
        Self {
            segments: known.segments.iter().map(segment).collect(),
            positions: known.positions.iter().map(|p| p.value().into()).collect(),
            on_skin: known.on_skin,
        }
    }

    /// Root first (head space, cm).
    pub fn positions(&self) -> &[Vector<S>] {
        &self.positions
    }

    /// Solves i = 1 .. k; p_i at frame n determines the force and whether eps_i applies. `disturbed`: the additional
    /// turn of theta and phi at the tip. `skin`: that of frame n + 1.
    #[inline(always)]
    pub fn step(&mut self, common: &Common, air: &impl Air<S>, disturbed: Option<[f64; 2]>, skin: Option<&SkinFrame>) {
        for (segment, &end) in self.segments.iter_mut().zip(&self.positions[1..]) {
            let force = air.force(end, &FieldShares::default());
            let weakened = common.gamma.contains(end.value(), force.value().as_vec3());
            let gain = if weakened { segment.shape.gain_in_gamma } else { segment.shape.gain };
            segment.advance(gain, force.by(&common.polar_from_head));
        }
        if let Some([theta, phi]) = disturbed {
            for segment in &mut self.segments {
                segment.theta += S::from(theta * segment.shape.along);
                segment.phi += S::from(phi * segment.shape.along);
            }
        }
        self.ride(skin);
        self.place(common);
    }

    /// Takes the root along with its skin. Angles are of head space, so nothing else goes along.
    fn ride(&mut self, skin: Option<&SkinFrame>) {
        if let (Some(place), Some(skin)) = (&self.on_skin, skin) {
            self.positions[0] = place.root(skin).into();
        }
    }

    /// Computes the points of the strand from its root outward.
    #[inline(always)]
    fn place(&mut self, common: &Common) {
        let head_from_polar = common.polar_from_head.transpose();
        let mut p = self.positions[0];
        for (segment, position) in self.segments.iter().zip(&mut self.positions[1..]) {
            p += segment.vector().by(&head_from_polar);
            *position = p;
        }
    }
}
