//! Building a scene, and changing it while it runs. Everything is checked here, once, so that a step need not.
//!
//! A call that is refused changes nothing. Adding, pinning, releasing and breaking renew the islands before the next
//! step, O(particles + springs·log); the other changes cost O(1).

use crate::error::EditError;
use crate::law::Mixed;
use crate::memory::{List, Memory};
use crate::real::Real;
use crate::scene::MassSpring;
use crate::selection::{self, Ends, MARK};
use crate::spring::{Spring, Stretched};
use crate::vec3::{self, Vec3};

impl<M: Memory> MassSpring<M> {
    /// Adds a free particle at rest; answers its index. Position in m, mass in kg, positive.
    ///
    /// # Errors
    /// [`EditError::NotFinite`], [`EditError::Mass`], [`EditError::ParticlesFull`].
    pub fn particle(&mut self, position: Vec3<M::Real>, mass: M::Real) -> Result<usize, EditError> {
        let i = self.network.mass.len();
        if !vec3::is_finite(position) {
            return Err(EditError::NotFinite(i));
        }
        valid_mass(i, mass)?;
        let room = self.network.mass.room();
        if i >= room || i >= MARK as usize - 1 {
            return Err(EditError::ParticlesFull(room));
        }
        self.islands.current = false;
        let zero = M::Real::ZERO;
        let (network, work) = (&mut self.network, &mut self.work);
        let pushed = network.position.push(position)
            && network.velocity.push([zero; 3])
            && network.mass.push(mass)
            && network.slot.push(0)
            && self.islands.push_particle()
            && [&mut work.x, &mut work.r, &mut work.b, &mut work.p, &mut work.y]
                .into_iter()
                .all(|v| v.push([zero; 3]))
            && work.inertia.push(zero)
            && work.mu.push(zero)
            && work.block.push([zero; 6]);
        if pushed { Ok(i) } else { Err(EditError::ParticlesFull(room)) }
    }

    /// Joins two particles by a spring whose rest length is their present distance; answers its index.
    ///
    /// # Errors
    /// [`EditError::NoParticle`], [`EditError::SameEnds`], [`EditError::Stiffness`], [`EditError::SpringsFull`].
    pub fn spring(&mut self, a: usize, b: usize, stiffness: M::Real) -> Result<usize, EditError> {
        for end in [a, b] {
            self.exists(end)?;
        }
        let delta = selection::difference(a, b, &self.network.position);
        let rest_length = Stretched::new(delta).length;
        self.spring_with(a, b, Spring { stiffness, rest_length })
    }

    /// Joins two particles by a spring of given stiffness (N/m) and rest length (m); answers its index.
    ///
    /// # Errors
    /// As [`MassSpring::spring`], and [`EditError::RestLength`].
    pub fn spring_with(&mut self, a: usize, b: usize, spring: Spring<M::Real>) -> Result<usize, EditError> {
        self.join(Ends { a, b, cable: false, broken: false }, spring)
    }

    fn join(&mut self, ends: Ends, spring: Spring<M::Real>) -> Result<usize, EditError> {
        let j = self.network.ends.len();
        for end in [ends.a, ends.b] {
            self.exists(end)?;
        }
        if ends.a == ends.b {
            return Err(EditError::SameEnds(j));
        }
        valid_stiffness(j, spring.stiffness)?;
        valid_rest_length(j, spring.rest_length)?;
        let room = self.network.ends.room();
        if j >= room || j >= MARK as usize - 1 {
            return Err(EditError::SpringsFull(room));
        }
        self.islands.current = false;
        let network = &mut self.network;
        let pushed = network.ends.push(ends.pack())
            && network.stiffness.push(spring.stiffness)
            && network.rest_length.push(spring.rest_length)
            && self.islands.push_spring()
            && self.work.hessian.push([M::Real::ZERO; 4]);
        if pushed { Ok(j) } else { Err(EditError::SpringsFull(room)) }
    }

    /// Pins a particle where it is: its velocity becomes 0 (also if it was a moving pin), it is no unknown any more, and
    /// rests unless a step is told its motion.
    ///
    /// # Errors
    /// [`EditError::NoParticle`].
    pub fn pin(&mut self, i: usize) -> Result<(), EditError> {
        let slot = self.network.slot.get_mut(i).ok_or(EditError::NoParticle(i))?;
        if *slot & MARK == 0 {
            *slot |= MARK;
            self.islands.current = false;
        }
        if let Some(v) = self.network.velocity.get_mut(i) {
            *v = [M::Real::ZERO; 3];
        }
        Ok(())
    }

    /// Releases a pinned particle; it goes on with the velocity it had as a pin (0 if it rested).
    ///
    /// # Errors
    /// [`EditError::NoParticle`], [`EditError::NotPinned`].
    pub fn release(&mut self, i: usize) -> Result<(), EditError> {
        let slot = self.network.slot.get_mut(i).ok_or(EditError::NoParticle(i))?;
        if *slot & MARK == 0 {
            return Err(EditError::NotPinned(i));
        }
        *slot &= !MARK;
        self.islands.current = false;
        Ok(())
    }

    /// Is particle i pinned?
    pub fn is_pinned(&self, i: usize) -> bool {
        self.state().is_pinned(i)
    }

    /// Breaks a spring for good: no force, no energy, no place in any island. Indices of the others stay.
    ///
    /// # Errors
    /// [`EditError::NoSpring`], [`EditError::Broken`].
    pub fn break_spring(&mut self, j: usize) -> Result<(), EditError> {
        self.unbroken(j)?;
        if let Some(pair) = self.network.ends.get_mut(j) {
            let mut ends = Ends::unpack(*pair);
            ends.broken = true;
            *pair = ends.pack();
            self.islands.current = false;
        }
        Ok(())
    }

    /// Changes k of a spring, N/m.
    ///
    /// # Errors
    /// [`EditError::NoSpring`], [`EditError::Broken`], [`EditError::Stiffness`].
    pub fn set_stiffness(&mut self, j: usize, stiffness: M::Real) -> Result<(), EditError> {
        self.unbroken(j)?;
        valid_stiffness(j, stiffness)?;
        put(&mut self.network.stiffness, j, stiffness);
        Ok(())
    }

    /// Changes l₀ of a spring, m.
    ///
    /// # Errors
    /// [`EditError::NoSpring`], [`EditError::Broken`], [`EditError::RestLength`].
    pub fn set_rest_length(&mut self, j: usize, rest_length: M::Real) -> Result<(), EditError> {
        self.unbroken(j)?;
        valid_rest_length(j, rest_length)?;
        put(&mut self.network.rest_length, j, rest_length);
        Ok(())
    }

    /// Changes the mass of a particle, kg. Its velocity stays.
    ///
    /// # Errors
    /// [`EditError::NoParticle`], [`EditError::Mass`].
    pub fn set_mass(&mut self, i: usize, mass: M::Real) -> Result<(), EditError> {
        self.exists(i)?;
        valid_mass(i, mass)?;
        put(&mut self.network.mass, i, mass);
        Ok(())
    }

    /// Puts a particle (pinned or free) somewhere else at once, m. To move a pin *over* a step see
    /// [`MassSpring::step_moving`].
    ///
    /// # Errors
    /// [`EditError::NoParticle`], [`EditError::NotFinite`].
    pub fn set_position(&mut self, i: usize, position: Vec3<M::Real>) -> Result<(), EditError> {
        self.exists(i)?;
        if !vec3::is_finite(position) {
            return Err(EditError::NotFinite(i));
        }
        put(&mut self.network.position, i, position);
        Ok(())
    }

    /// Sets the velocity of a free particle, m/s.
    ///
    /// # Errors
    /// [`EditError::NoParticle`], [`EditError::Pinned`], [`EditError::NotFinite`].
    pub fn set_velocity(&mut self, i: usize, velocity: Vec3<M::Real>) -> Result<(), EditError> {
        self.exists(i)?;
        if self.is_pinned(i) {
            return Err(EditError::Pinned(i));
        }
        if !vec3::is_finite(velocity) {
            return Err(EditError::NotFinite(i));
        }
        put(&mut self.network.velocity, i, velocity);
        Ok(())
    }

    /// Gives a free particle an impulse, N·s: q̇ += impulse/m.
    ///
    /// # Errors
    /// As [`MassSpring::set_velocity`].
    pub fn impulse(&mut self, i: usize, impulse: Vec3<M::Real>) -> Result<(), EditError> {
        self.exists(i)?;
        let (Some(m), Some(v)) = (self.network.mass.get(i), self.network.velocity.get(i)) else {
            return Err(EditError::NoParticle(i));
        };
        let velocity = vec3::add(*v, vec3::map(impulse, |p| p / *m));
        self.set_velocity(i, velocity)
    }

    fn exists(&self, i: usize) -> Result<(), EditError> {
        if i < self.network.mass.len() { Ok(()) } else { Err(EditError::NoParticle(i)) }
    }

    fn unbroken(&self, j: usize) -> Result<(), EditError> {
        match self.network.ends.get(j) {
            None => Err(EditError::NoSpring(j)),
            Some(pair) if Ends::unpack(*pair).broken => Err(EditError::Broken(j)),
            Some(_) => Ok(()),
        }
    }
}

impl<M: Memory<Law = Mixed>> MassSpring<M> {
    /// Joins two particles by a cable: a spring that only pulls.
    ///
    /// # Errors
    /// As [`MassSpring::spring_with`].
    pub fn cable(&mut self, a: usize, b: usize, spring: Spring<M::Real>) -> Result<usize, EditError> {
        self.join(Ends { a, b, cable: true, broken: false }, spring)
    }
}

fn put<X>(list: &mut [X], i: usize, x: X) {
    if let Some(place) = list.get_mut(i) {
        *place = x;
    }
}

fn valid_mass<T: Real>(i: usize, mass: T) -> Result<(), EditError> {
    if mass.is_finite() && mass > T::ZERO { Ok(()) } else { Err(EditError::Mass(i)) }
}

fn valid_stiffness<T: Real>(j: usize, stiffness: T) -> Result<(), EditError> {
    if stiffness.is_finite() && stiffness >= T::ZERO { Ok(()) } else { Err(EditError::Stiffness(j)) }
}

fn valid_rest_length<T: Real>(j: usize, rest_length: T) -> Result<(), EditError> {
    if rest_length.is_finite() && rest_length >= T::ZERO { Ok(()) } else { Err(EditError::RestLength(j)) }
}
