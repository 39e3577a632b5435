//! Values as rows of numbers, as they pass to the device and back.

use glam::{Vec2, Vec3, Vec4};

/// A value that consists of numbers.
pub trait Flat {
    /// Takes the value's numbers from the front.
    fn read(from: &mut std::slice::Iter<f32>) -> Self;

    /// Appends the value's numbers.
    fn write(&self, to: &mut Vec<f32>);
}

impl Flat for f32 {
    fn read(from: &mut std::slice::Iter<f32>) -> Self {
        *from.next().expect("a number")
    }

    fn write(&self, to: &mut Vec<f32>) {
        to.push(*self);
    }
}

impl Flat for u32 {
    fn read(from: &mut std::slice::Iter<f32>) -> Self {
        f32::read(from) as u32
    }

    fn write(&self, to: &mut Vec<f32>) {
        to.push(*self as f32);
    }
}

impl Flat for bool {
    fn read(from: &mut std::slice::Iter<f32>) -> Self {
        f32::read(from) != 0.0
    }

    fn write(&self, to: &mut Vec<f32>) {
        to.push(f32::from(*self));
    }
}

macro_rules! flat_vector {
    ($($type:ty, $count:literal);+) => {
        $(impl Flat for $type {
            fn read(from: &mut std::slice::Iter<f32>) -> Self {
                <[f32; $count]>::read(from).into()
            }

            fn write(&self, to: &mut Vec<f32>) {
                self.to_array().write(to);
            }
        })+
    };
}

flat_vector!(Vec2, 2; Vec3, 3; Vec4, 4);

impl<T: Flat, const N: usize> Flat for [T; N] {
    fn read(from: &mut std::slice::Iter<f32>) -> Self {
        std::array::from_fn(|_| T::read(from))
    }

    fn write(&self, to: &mut Vec<f32>) {
        for value in self {
            value.write(to);
        }
    }
}

/// `Flat` of structs, field by field.
macro_rules! flat_struct {
    ($($type:ty { $($field:ident),+ })+) => {
        $(impl crate::flat::Flat for $type {
            fn read(from: &mut std::slice::Iter<f32>) -> Self {
                Self { $($field: crate::flat::Flat::read(from)),+ }
            }

            fn write(&self, to: &mut Vec<f32>) {
                $(self.$field.write(to);)+
            }
        })+
    };
}

pub(crate) use flat_struct;

/// A twin, called with rows of numbers.
pub type FlatFunction = Box<dyn Fn(&[f32]) -> Vec<f32>>;

/// A function of values that consist of numbers.
pub trait Twin<Arguments> {
    /// The function of the numbers of its arguments.
    fn flat(self) -> FlatFunction;
}

macro_rules! twin {
    ($($argument:ident)*) => {
        impl<F, R, $($argument),*> Twin<($($argument,)*)> for F
        where
            F: Fn($($argument),*) -> R + 'static,
            R: Flat,
            $($argument: Flat),*
        {
            fn flat(self) -> FlatFunction {
                Box::new(move |numbers| {
                    #[allow(unused_mut, unused_variables)]
                    let mut numbers = numbers.iter();
                    let mut result = Vec::new();
                    self($($argument::read(&mut numbers)),*).write(&mut result);
                    result
                })
            }
        }
    };
}

twin!();
twin!(A);
twin!(A B);
twin!(A B C);
twin!(A B C D);
twin!(A B C D E);
twin!(A B C D E G);
twin!(A B C D E G H);
twin!(A B C D E G H I);
twin!(A B C D E G H I J);
twin!(A B C D E G H I J K);
