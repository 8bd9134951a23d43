//! Jobs on any adapter of this machine.

use orogen_gpu::gpu::Options;
use orogen_gpu::job::{Dispatch, Job};
use orogen_gpu::{Choice, Gpu};

#[test]
fn a_job_runs() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    println!("{}", gpu.adapter());
    let text = "@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n\
        if (id.x >= frame.width || id.y >= frame.height) { return; }\n\
        let at = id.y * frame.width + id.x;\n\
        samples[at] = samples[at] * number(frame.base, 0u) + f32(frame.step);\n}\n";
    let grid: Vec<f32> = (0..13 * 9).map(|k| k as f32).collect();
    let dispatch = |step| Dispatch { text, base: 1, size: [13, 9], step, ..Dispatch::default() };
    let job = Job {
        data: vec![0, 2.0f32.to_bits()],
        samples: grid.len(),
        uploads: vec![(0, grid.as_slice().into())],
        dispatches: vec![dispatch(1), dispatch(0)],
        downloads: vec![(0, grid.len())],
        ..Job::default()
    };
    let back = job.run(&gpu, || false).unwrap().unwrap();
    assert!(back[0].iter().zip(&grid).all(|(made, k)| *made == 4.0 * k + 2.0));
    assert_eq!(gpu.shaders_compiled(), 1);
    assert!(job.run(&gpu, || true).unwrap().is_none());
    gpu.lose();
    assert!(job.run(&gpu, || false).is_err());
}
