//! The specification: projective equations one segment at a time, in f64, as the paper writes them.

use glam::{DMat3, DVec3};

use super::angles::{POLE_REST, POLE_SINE, azimuth, from_direction, to_direction};
use super::polar::PolarAxis;
use crate::dynamics::gain::{SegmentShape, Stability, segment_shapes};
use crate::dynamics::{Dynamics, ForceSpace, FrameInput, Stepper};
use crate::error::SettingError;
use crate::field::Field;
use crate::pseudo_force::Gamma;
use crate::strands::Strands;

/// The paper's form of [`Reference`](crate::dynamics::Reference).
pub(in crate::dynamics) struct Reference {
    dynamics: Dynamics,
    gamma: Gamma,
    /// From head space to the space whose y is the polar axis, in which angles are counted.
    polar_from_head: DMat3,
    segments: Vec<Segment>,
    ids: Vec<u32>,
    frame: u32,
    positions: Vec<DVec3>,
    strands: Strands,
}

/// One segment s_i: its angles at frame n, and what moves it.
struct Segment {
    shape: SegmentShape,
    theta: f64,
    phi: f64,
    /// theta^n - theta^(n-1) (rad).
    theta_increment: f64,
    /// phi^n - phi^(n-1) (rad).
    phi_increment: f64,
}

impl Segment {
    /// Equation (7) for theta and for phi. `gain`: c_i or eps_i c_i; `force`: F(n+1), in the space of the angles.
    fn advance(&mut self, gain: f64, force: DVec3) {
        let at_rest_on_the_pole = self.theta.sin().abs() < POLE_SINE && self.theta_increment.abs() < POLE_REST;
        if at_rest_on_the_pole && let Some(azimuth) = azimuth(force) {
            self.phi = azimuth;
        }
        let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (self.theta.sin_cos(), self.phi.sin_cos());
        let v_theta = DVec3::new(cos_theta * sin_phi, -sin_theta, cos_theta * cos_phi);
        // v_i V_phi over u_i: the lever |s*| / 2 = d sin(theta) / 2, so that gain needs no second form.
        let v_phi = sin_theta * DVec3::new(cos_phi, 0.0, -sin_phi);
        self.theta_increment += gain * force.dot(v_theta);
        self.phi_increment += gain * force.dot(v_phi);
        self.theta += self.theta_increment;
        self.phi += self.phi_increment;
    }

    fn vector(&self) -> DVec3 {
        self.shape.length * to_direction(self.theta, self.phi)
    }
}

impl Reference {
    pub fn new(strands: &Strands, ids: &[u32], dynamics: &Dynamics, field: &dyn Field) -> Result<Self, SettingError> {
        Stability::of(strands, dynamics)?.check(field)?;
        let polar_from_head = PolarAxis::new(dynamics.polar_axis).polar_from_head();
        let mut segments = Vec::with_capacity(strands.segment_count());
        for (s, strand) in strands.iter().enumerate() {
            for (shape, w) in segment_shapes(dynamics, strand, s)?.into_iter().zip(strand.windows(2)) {
                let (theta, phi) = from_direction(polar_from_head * (w[1].as_dvec3() - w[0].as_dvec3()));
                segments.push(Segment { shape, theta, phi, theta_increment: 0.0, phi_increment: 0.0 });
            }
        }
        let mut reference = Self {
            dynamics: dynamics.clone(),
            gamma: dynamics.gamma(),
            polar_from_head,
            segments,
            ids: ids.to_vec(),
            frame: 0,
            positions: strands.points().iter().map(|p| p.as_dvec3()).collect(),
            strands: strands.clone(),
        };
        reference.place();
        Ok(reference)
    }

    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Solves i = 1 .. k for every strand; p_i at frame n decides what the force is and whether eps_i holds.
    fn advance(&mut self, input: &FrameInput) {
        for s in 0..self.strands.len() {
            let points = self.strands.range(s);
            for i in 0..points.len() - 1 {
                let end = self.positions[points.start + i + 1];
                let force = self.force_in_head(end, input);
                let weakened = self.gamma.contains(end, force.as_vec3());
                let segment = &mut self.segments[points.start - s + i];
                let gain = if weakened { segment.shape.gain_in_gamma } else { segment.shape.gain };
                segment.advance(gain, self.polar_from_head * force);
            }
        }
    }

    /// F(n+1) at a point, both in head space.
    fn force_in_head(&self, point: DVec3, input: &FrameInput) -> DVec3 {
        let FrameInput { frame, pose, field, .. } = input;
        match self.dynamics.motion.force_space {
            ForceSpace::Head => field.at(point.as_vec3(), *frame).as_dvec3(),
            ForceSpace::World => {
                let rotation = pose.rotation.as_dquat();
                let in_world = rotation * point + pose.position_cm.as_dvec3();
                rotation.inverse() * field.at(in_world.as_vec3(), *frame).as_dvec3()
            }
        }
    }

    fn disturb(&mut self) {
        let Some(disturbance) = &self.dynamics.disturbance else { return };
        let Some(part) = disturbance.part(self.frame) else { return };
        for (s, &id) in self.ids.iter().enumerate() {
            let [theta, phi] = disturbance.turn(id, &part).map(f64::from);
            let points = self.strands.range(s);
            for segment in &mut self.segments[points.start - s..points.end - s - 1] {
                segment.theta += theta * segment.shape.along;
                segment.phi += phi * segment.shape.along;
            }
        }
    }

    /// Puts the strands together from their roots outward.
    fn place(&mut self) {
        for s in 0..self.strands.len() {
            let points = self.strands.range(s);
            let mut p = self.positions[points.start];
            for (i, segment) in self.segments[points.start - s..points.end - s - 1].iter().enumerate() {
                p += self.polar_from_head.transpose() * segment.vector();
                self.positions[points.start + i + 1] = p;
            }
        }
        for (point, p) in self.strands.points_mut().iter_mut().zip(&self.positions) {
            *point = p.as_vec3();
        }
    }
}

impl Stepper for Reference {
    fn step_frame(&mut self, input: &FrameInput) {
        self.advance(input);
        self.frame = input.frame;
        self.disturb();
        self.place();
    }

    fn frame(&self) -> u32 {
        self.frame
    }

    fn strands(&self) -> &Strands {
        &self.strands
    }
}
