/// The indices, by rising cost, of the points `[cost, error]` that no other point beats. A point beats another if neither
/// its cost nor its error is larger and one of them is smaller. Points that are not numbers are left out; equal points
/// all stay.
pub fn undominated(points: &[[f64; 2]]) -> Vec<usize> {
    let dominates = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let mut best: Vec<usize> = (0..points.len())
        .filter(|&i| points[i].iter().all(|v| !v.is_nan()))
        .filter(|&i| !points.iter().any(|other| dominates(other, &points[i])))
        .collect();
    best.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]));
    best
}

#[cfg(test)]
mod tests;
