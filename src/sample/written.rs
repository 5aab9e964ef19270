//! What is written in place of the truth: poses, focal length and world with errors drawn into them,
//! each normal with the standard deviation that the flight then states. The photos and the truth stay
//! as they are. Each kind has random numbers of its own, so that one does not move another.

use glam::{DMat3, DQuat, DVec3};

use super::flight_plan::Shot;
use super::random::Random;
use crate::camera::{Camera, Pose};
use crate::exports::{Orientation, PoseRow, StatedDeviations};
use crate::fault::Fault;

/// Standard deviations of the errors of poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseNoise {
    /// Of camera centres, each axis, metres of the true world.
    pub position: f64,
    /// Of the rotation about each camera axis, degrees.
    pub angle: f64,
}

/// Standard deviations of the errors that are drawn into what is written. `None`: none is drawn, and
/// nothing is stated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DrawnErrors {
    /// Of each photo's pose.
    pub pose: Option<PoseNoise>,
    /// Of fx and fy together, percent; one draw a flight.
    pub lens: Option<f64>,
    /// Of all lengths of the world, percent; one draw a flight.
    pub world: Option<f64>,
}

/// The streams of random numbers, forked from the flight's.
const POSE: u64 = 40;
const LENS: u64 = 41;
const WORLD: u64 = 42;

/// What is written of a flight's poses, focal length and lengths.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Written {
    errors: DrawnErrors,
    focal_factor: f64,
    world_factor: f64,
    /// In the lab's frame, one a photo.
    poses: Vec<Pose>,
}

impl Written {
    /// Draws what is written of these photos.
    ///
    /// # Errors
    /// Where so large a deviation turns the camera or the world inside out.
    pub(super) fn draw(
        errors: &DrawnErrors,
        shots: &[Shot],
        random: &Random,
    ) -> Result<Self, Fault> {
        let focal_factor = factor("focal length", errors.lens, &mut random.fork(LENS))?;
        let world_factor = factor("world", errors.world, &mut random.fork(WORLD))?;
        let of_poses = random.fork(POSE);
        let pose = |(number, shot): (u64, &Shot)| {
            let mut pose = shot.pose();
            if let Some(noise) = errors.pose {
                let mut random = of_poses.fork(number);
                let mut three = || DVec3::new(random.normal(), random.normal(), random.normal());
                pose.center += three() * noise.position;
                let turn = three() * noise.angle.to_radians();
                pose.rotation *= DMat3::from_quat(DQuat::from_scaled_axis(turn));
            }
            pose.center *= world_factor;
            pose
        };
        Ok(Self {
            errors: *errors,
            focal_factor,
            world_factor,
            poses: (0..).zip(shots).map(pose).collect(),
        })
    }

    /// Whether errors were asked for.
    pub(super) fn differs(&self) -> bool {
        self.errors != DrawnErrors::default()
    }

    /// By what the true fx and fy are multiplied.
    pub(super) fn focal_factor(&self) -> f64 {
        self.focal_factor
    }

    /// By what all true lengths are multiplied, about the lab's middle.
    pub(super) fn world_factor(&self) -> f64 {
        self.world_factor
    }

    /// The pose of a photo, in the lab's frame.
    pub(super) fn pose(&self, photo: usize) -> Option<&Pose> {
        self.poses.get(photo)
    }

    /// Of the true camera.
    pub(super) fn camera(&self, camera: &Camera) -> Camera {
        Camera {
            fx: camera.fx * self.focal_factor,
            fy: camera.fy * self.focal_factor,
            ..camera.clone()
        }
    }

    /// The lines of poses.csv. The angles that the photos were flown with stay in it as they are unless
    /// errors are drawn into them: those turn about all three axes.
    pub(super) fn pose_rows(&self, shots: &[Shot], origin: DVec3) -> Vec<PoseRow> {
        let row = |(shot, pose): (&Shot, &Pose)| {
            let placed = Pose {
                center: pose.center + origin,
                ..*pose
            };
            let row = PoseRow::of_pose(&shot.name, &placed);
            match self.errors.pose {
                Some(noise) => PoseRow {
                    stated: Some(StatedDeviations {
                        position: DVec3::splat(noise.position),
                        angle: noise.angle,
                    }),
                    ..row
                },
                None => PoseRow {
                    orientation: Orientation::TiltPan(shot.actual.1),
                    ..row
                },
            }
        };
        shots.iter().zip(&self.poses).map(row).collect()
    }
}

/// 1 plus a draw of a standard deviation in percent.
fn factor(of: &str, percent: Option<f64>, random: &mut Random) -> Result<f64, Fault> {
    let factor = 1.0 + random.normal() * percent.unwrap_or(0.0) / 100.0;
    if factor > 0.0 {
        return Ok(factor);
    }
    Err(Fault::new(
        format!("the {of} was drawn {factor:.3} times the true one, which is none"),
        "ask for less noise, or name another seed",
    ))
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::{Lens, Preset};

    const SEEDS: u64 = 400;

    /// Two photos.
    fn shots() -> Vec<Shot> {
        let mut flight = Preset::Lab.recipe(Lens::None).unwrap().flight;
        flight.count = [1, 2];
        flight.fly(&mut Random::new(1))
    }

    fn drawn(errors: DrawnErrors, seed: u64) -> Written {
        Written::draw(&errors, &shots(), &Random::new(seed)).unwrap()
    }

    /// Draws that should be standard normal: mean 0 within 4.5 of its standard errors, and the sum of
    /// their squares within 4.5 standard deviations, sqrt(2 n), of chi square's mean n.
    fn assert_standard(what: &str, draws: &[f64]) {
        let n = draws.len() as f64;
        let mean = draws.iter().sum::<f64>() / n;
        assert!(mean.abs() < 4.5 / n.sqrt(), "{what}: mean {mean}");
        let squares: f64 = draws.iter().map(|draw| draw * draw).sum();
        let off = (squares - n) / (2.0 * n).sqrt();
        assert!(
            off.abs() < 4.5,
            "{what}: chi square off by {off} of its own"
        );
    }

    fn correlation(a: &[f64], b: &[f64]) -> f64 {
        let product = |(a, b): (&f64, &f64)| a * b;
        a.iter().zip(b).map(product).sum::<f64>() / a.len() as f64
    }

    /// The rotation vector in camera axes that takes the true rotation to the written one, by its
    /// angle and antisymmetric part.
    fn turned(written: &DMat3, actual: &DMat3) -> DVec3 {
        let turn = actual.transpose() * *written;
        let [x, y, z] = [turn.x_axis, turn.y_axis, turn.z_axis];
        let twice_sine = DVec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
        let angle = ((x.x + y.y + z.z - 1.0) / 2.0).clamp(-1.0, 1.0).acos();
        // Near 1 the arc cosine loses half of the digits.
        let angle = if angle < 0.1 {
            (twice_sine.length() / 2.0).asin()
        } else {
            angle
        };
        twice_sine.normalize() * angle
    }

    /// Over many seeds, for each axis of each photo by itself.
    #[test]
    fn poses_have_the_stated_deviations() {
        let pose = Some(PoseNoise {
            position: 0.02,
            angle: 0.5,
        });
        let errors = DrawnErrors {
            pose,
            ..DrawnErrors::default()
        };
        let mut draws = vec![Vec::new(); 12];
        for seed in 0..SEEDS {
            let written = drawn(errors, seed);
            for (photo, shot) in shots().iter().enumerate() {
                let (pose, actual) = (written.pose(photo).unwrap(), shot.pose());
                let moved = (pose.center - actual.center) / 0.02;
                let turned = turned(&pose.rotation, &actual.rotation) / 0.5_f64.to_radians();
                let numbers = moved.to_array().into_iter().chain(turned.to_array());
                for (axis, number) in numbers.enumerate() {
                    draws[photo * 6 + axis].push(number);
                }
                let product = pose.rotation.transpose() * pose.rotation - DMat3::IDENTITY;
                assert!(product.to_cols_array().iter().all(|x| x.abs() < 1e-14));
            }
        }
        for (index, of_axis) in draws.iter().enumerate() {
            assert_standard(&format!("number {index}"), of_axis);
            for (other, of_other) in draws.iter().enumerate().take(index) {
                let correlation = correlation(of_axis, of_other);
                assert!(
                    correlation.abs() < 4.5 / 20.0,
                    "{index} {other}: {correlation}"
                );
            }
        }
    }

    #[test]
    fn factors_have_the_stated_deviations() {
        let errors = DrawnErrors {
            pose: None,
            lens: Some(0.5),
            world: Some(3.0),
        };
        let (mut lens, mut world) = (Vec::new(), Vec::new());
        for seed in 0..SEEDS {
            let written = drawn(errors, seed);
            lens.push((written.focal_factor() - 1.0) / 0.005);
            world.push((written.world_factor() - 1.0) / 0.03);
        }
        assert_standard("lens", &lens);
        assert_standard("world", &world);
        assert!(correlation(&lens, &world).abs() < 4.5 / 20.0);
    }

    /// Noise is added in the true world, and all is scaled then.
    #[test]
    fn the_world_scales_noisy_centers() {
        let pose = Some(PoseNoise {
            position: 0.02,
            angle: 0.5,
        });
        let only_pose = DrawnErrors {
            pose,
            ..DrawnErrors::default()
        };
        let world = Some(10.0);
        let (noisy, scaled) = (
            drawn(only_pose, 9),
            drawn(DrawnErrors { world, ..only_pose }, 9),
        );
        let factor = scaled.world_factor();
        assert_eq!(noisy.world_factor(), 1.0);
        for (a, b) in noisy.poses.iter().zip(&scaled.poses) {
            assert_eq!(a.center * factor, b.center);
            assert_eq!(a.rotation, b.rotation);
        }
        let rows = scaled.pose_rows(&shots(), DVec3::new(5e5, 5e6, 300.0));
        let stated = rows[1].stated.unwrap();
        assert_eq!((stated.position, stated.angle), (DVec3::splat(0.02), 0.5));
    }

    #[test]
    fn without_errors_all_is_as_it_was() {
        let written = drawn(DrawnErrors::default(), 3);
        assert!(!written.differs());
        assert_eq!((written.focal_factor(), written.world_factor()), (1.0, 1.0));
        let camera = Preset::Lab.recipe(Lens::Brown).unwrap().camera;
        assert_eq!(written.camera(&camera), camera);
        for (row, shot) in written.pose_rows(&shots(), DVec3::X).iter().zip(shots()) {
            assert_eq!(row.center, shot.actual.0 + DVec3::X);
            assert_eq!(row.orientation, Orientation::TiltPan(shot.actual.1));
            assert_eq!(row.stated, None);
        }
    }

    /// Stated as known exactly: nothing moves but the kind of orientation.
    #[test]
    fn no_deviation_moves_nothing() {
        let errors = DrawnErrors {
            pose: Some(PoseNoise {
                position: 0.0,
                angle: 0.0,
            }),
            lens: Some(0.0),
            world: Some(0.0),
        };
        let written = drawn(errors, 3);
        assert!(written.differs());
        assert_eq!((written.focal_factor(), written.world_factor()), (1.0, 1.0));
        for (pose, shot) in written.poses.iter().zip(shots()) {
            assert_eq!(*pose, shot.pose());
        }
    }

    /// A draw of minus two deviations of 50 %.
    #[test]
    fn a_world_inside_out_is_refused() {
        let errors = DrawnErrors {
            world: Some(50.0),
            ..DrawnErrors::default()
        };
        let all = (0..SEEDS).map(|seed| Written::draw(&errors, &shots(), &Random::new(seed)));
        let refused: Vec<Fault> = all.filter_map(Result::err).collect();
        // 2.3 % of them: 9.1 of 400, with a deviation of 3.
        assert!((1..=22).contains(&refused.len()), "{}", refused.len());
        assert!(refused[0].to_string().contains("the world was drawn -"));
    }

    /// More photos at the end (a ring) do not move those before.
    #[test]
    fn each_photo_has_its_own_numbers() {
        let pose = Some(PoseNoise {
            position: 0.1,
            angle: 1.0,
        });
        let errors = DrawnErrors {
            pose,
            ..DrawnErrors::default()
        };
        let random = Random::new(5);
        let mut plan = Preset::Lab.recipe(Lens::None).unwrap().flight;
        plan.spacing = DVec2::ONE;
        let mut shots = plan.fly(&mut random.fork(20));
        let few = Written::draw(&errors, &shots, &random).unwrap();
        shots.extend(plan.ring(4, &mut random.fork(21)));
        let more = Written::draw(&errors, &shots, &random).unwrap();
        assert_eq!(few.poses[..], more.poses[..few.poses.len()]);
        assert_eq!(more.poses.len(), few.poses.len() + 4);
    }
}
