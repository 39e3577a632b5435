//! Counts of a shader that runs on a Vulkan device.

mod vulkan;

use airlight_shaders::{Counts, counting};
use wgpu::util::DeviceExt;

/// Invocation k of four takes a loop of k steps, a branch of its own, and returns early or at the end.
const SHADER: &str = "
@group(0) @binding(0) var table: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> sums: array<f32>;

fn place(k: u32) -> f32 {
    return f32(k) + textureLoad(table, vec2<i32>(0, 0), 0).x;
}

@compute @workgroup_size(4)
fn fill(@builtin(local_invocation_index) index: u32) {
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < index; k++) {
        sum += exp(-vec3<f32>(place(k)));
    }
    switch index {
        case 0u: {
            sums[index] = 7.0;
            return;
        }
        case 1u: {
            sum.x += log(2.0 + place(index));
        }
        default: {
            if index == 3u && place(9u) > 1e6 {
                sum.y += pow(sum.y, 3.0);
            }
        }
    }
    sums[index] = sum.x + sum.y;
}";

#[test]
fn what_runs_is_counted() {
    let shader = counting(SHADER, (1, 0), "place").unwrap();
    let (_, device, queue) = vulkan::open();
    let table = airlight_shaders::twins::texture::Texture::new([1, 1, 1], vec![glam::Vec4::ONE]);
    let table = vulkan::uploaded(&device, &queue, &table);
    let buffer = |label, size: u64| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: &vec![0; size as usize],
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        })
    };
    let sums = buffer("sums", 16);
    let counts = buffer("counts", Counts::BYTES);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(shader.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("fill"),
        compilation_options: Default::default(),
        cache: None,
    });
    let group = |index, entries: &[(u32, wgpu::BindingResource<'_>)]| {
        let entries = entries.iter().cloned();
        let entries: Vec<_> = entries
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(index),
            entries: &entries,
        })
    };
    let view = wgpu::BindingResource::TextureView(&table);
    let first = group(0, &[(0, view), (1, sums.as_entire_binding())]);
    let second = group(1, &[(0, counts.as_entire_binding())]);
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &first, &[]);
        pass.set_bind_group(1, &second, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
    queue.submit([encoder.finish()]);
    let read = |buffer: &wgpu::Buffer| -> [u8; 16] {
        let bytes = vulkan::read(&device, &queue, buffer);
        bytes.try_into().expect("16 bytes")
    };
    // Steps of the loops: 0, 1, 2 and 3, each of which calls `place` once and takes three exponentials; then invocation 1 takes a
    // logarithm of a place, and invocation 3 a place.
    let right = Counts {
        invocations: 4,
        exp: 6 * 3 + 1,
        reads: 6 + 2,
        calls: 6 + 2,
    };
    assert_eq!(Counts::from_bytes(read(&counts)), right);
    // Results are those of the shader itself.
    let sums = read(&sums);
    let e = |k: f32| (-k - 1.0).exp();
    let right = [
        7.0,
        2.0 * e(0.0) + 4f32.ln(),
        2.0 * (e(0.0) + e(1.0)),
        2.0 * (e(0.0) + e(1.0) + e(2.0)),
    ];
    for (sum, right) in sums.as_chunks::<4>().0.iter().zip(right) {
        let sum = f32::from_ne_bytes(*sum);
        assert!((sum / right - 1.0).abs() < 1e-5, "{sum} {right}");
    }
}

#[test]
fn fragments_count_up_to_where_they_discard_and_vertices_do_not() {
    let shader = "
        @vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
            return vec4<f32>(exp(f32(i)), 0.0, 0.0, 1.0);
        }
        fn kept(x: f32) -> f32 {
            if x > 2.0 { discard; }
            return exp(x);
        }
        @fragment fn draw(@builtin(position) p: vec4<f32>) -> @location(0) vec4<f32> {
            return vec4<f32>(kept(p.x));
        }";
    let shader = counting(shader, (3, 1), "kept").unwrap();
    assert!(shader.contains("@group(3) @binding(1)"));
    let parts = |from: &str, to: &str| {
        let start = shader.find(from).expect(from);
        let end = shader[start..].find(to).map_or(shader.len(), |k| start + k);
        shader[start..end].matches("atomicAdd").count()
    };
    assert_eq!(parts("fn kept", "@vertex"), 4, "{shader}");
    assert_eq!(parts("fn corner", "@fragment"), 0);
    assert_eq!(parts("fn draw", "nothing behind it"), 4);
    assert!(counting("fn f(", (0, 0), "").is_err());
}
