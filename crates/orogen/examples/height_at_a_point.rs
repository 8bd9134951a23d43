//! The height at a point and along a path. No raster is computed, whatever the size of the world.
//!
//! `cargo run --release --example height_at_a_point`

fn main() -> orogen::Result<()> {
    let world = orogen::open("alpine")?;

    let (east, south) = (30_720.0, 30_720.0);
    println!("{east} m east and {south} m south stands {:.1} m high", world.height(east, south)?);

    // One call for many points is faster than one call per point.
    let x: Vec<f64> = (0..=40).map(|step| 10_000.0 + 1000.0 * f64::from(step)).collect();
    let y = vec![south; x.len()];
    for (x, height) in x.iter().zip(world.points("height", &x, &y)?) {
        println!("{:6.1} km {height:7.1} m {}", x / 1000.0, "#".repeat((height / 60.0).max(0.0) as usize));
    }
    Ok(())
}
